// Usage: node validate.js FILE... : prints every error and warning, one a line; ends with 1 if there is an error.
import {readFileSync} from 'node:fs';
import {validateBytes} from 'gltf-validator';

let errors = 0;
for (const file of process.argv.slice(2)) {
  const {issues} = await validateBytes(new Uint8Array(readFileSync(file)), {maxIssues: 0, writeTimestamp: false});
  errors += issues.numErrors;
  for (const {severity, code, message, pointer} of issues.messages)
    if (severity <= 1) console.log(`${file}: ${severity === 0 ? 'error' : 'warning'} ${code} ${pointer}: ${message}`);
}
process.exit(errors > 0 ? 1 : 0);
