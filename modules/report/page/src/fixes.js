// What a person put right, as the file that `drape run --fixes` reads.

const round = (value, digits) => Number(value.toPrecision(digits));

/** The numbers of a camera or of a place, short and exact enough. */
export function rounded(values, digits = 9) {
  return values.map((value) => round(value, digits));
}

export function pixels(values) {
  return values.map((value) => Math.round(value * 10) / 10);
}

// JSON is YAML, and quotes whatever name a file may have.
const text = (value) => JSON.stringify(value);

function lines(value, indent) {
  const out = [];
  for (const [key, entry] of Object.entries(value)) {
    if (Array.isArray(entry) && entry.length > 0 && typeof entry[0] === 'object') {
      out.push(`${indent}${key}:`, ...entry.map((one) => `${indent}  - ${flow(one)}`));
    } else if (entry !== null && typeof entry === 'object' && !Array.isArray(entry)) {
      out.push(`${indent}${key}:`, ...lines(entry, indent + '  '));
    } else {
      out.push(`${indent}${key}: ${flow(entry)}`);
    }
  }
  return out;
}

function flow(value) {
  if (Array.isArray(value)) return `[${value.map(flow).join(', ')}]`;
  if (value !== null && typeof value === 'object')
    return `{${Object.entries(value).map(([key, entry]) => `${key}: ${flow(entry)}`).join(', ')}}`;
  return typeof value === 'number' || typeof value === 'boolean' ? String(value) : text(value);
}

/** One object's entry of the list `fixes:`. */
function entry({object, photos}) {
  const out = [`  - object: ${text(object)}`, '    photos:'];
  for (const [name, fix] of Object.entries(photos)) out.push(`      ${text(name)}:`, ...lines(fix, '        '));
  return out;
}

/** The whole file. `objects`: {object, photos: {file name: fix}}. */
export function fixesFile(objects) {
  return ['fixes:', ...objects.flatMap(entry)].join('\n') + '\n';
}

export function download(content) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([content], {type: 'application/yaml'}));
  link.download = 'fixes.yaml';
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// What says the same in two ways: the later one holds.
const rivals = {
  initial: ['points'],
  points: ['initial'],
  segments: ['box_px', 'click_px', 'strokes'],  // they are numbered anew where these change
  box_px: ['segments'],
  click_px: ['segments'],
  strokes: ['segments'],
};

/** The fixes of one object as they grow on its page. */
export class Fixes {
  constructor(object) {
    this.object = object;
    this.photos = {};
    this.changed = () => {};
  }

  of(photo) {
    return this.photos[photo] ?? {};
  }

  /** Takes the value for a key; nothing takes the key away. "camera.initial" is a key of a section. */
  set(photo, key, value) {
    const fix = structuredClone(this.of(photo));
    const [section, inner] = key.split('.');
    if (inner) {
      const map = fix[section] ?? {};
      if (value !== undefined) for (const rival of rivals[inner] ?? []) delete map[rival];
      if (value === undefined) delete map[inner];
      else map[inner] = value;
      if (Object.keys(map).length > 0) fix[section] = map;
      else delete fix[section];
    } else if (value === undefined) {
      delete fix[section];
    } else {
      for (const rival of rivals[section] ?? []) delete fix[rival];
      fix[section] = value;
    }
    if (Object.keys(fix).length > 0) this.photos[photo] = fix;
    else delete this.photos[photo];
    this.changed();
  }

  clear() {
    this.photos = {};
    this.changed();
  }

  get empty() {
    return Object.keys(this.photos).length === 0;
  }

  get file() {
    return this.empty ? 'fixes: []\n' : fixesFile([this]);
  }
}
