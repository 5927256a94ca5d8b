// The card on which a person puts a run right; all of it ends in one file.
import {button, choice, element} from './dom.js';
import {download, Fixes} from './fixes.js';
import {PhotoPad} from './pad.js';
import {PointsTool} from './points_tool.js';
import {PoseOverlay} from './pose_overlay.js';
import {PoseTool} from './pose_tool.js';
import {BoxTool, ClickTool, SegmentsTool, StrokesTool} from './region_tools.js';

const quoted = (path) => (/^[\w@%+=:,./-]+$/.test(path) ? path : `'${path.replaceAll("'", "'\\''")}'`);

function command(data) {
  return data.batch
    ? `drape batch apply fixes.yaml ${quoted(data.config)}`
    : `drape run ${quoted(data.config)} --fixes fixes.yaml`;
}

/** What was put right, and how to make use of it. */
function outcome(fixes, data, forget) {
  const file = element('pre', {class: 'wrap'}, element('code'));
  const load = button('Download fixes.yaml', () => download(fixes.file), {class: 'main', id: 'download-fixes'});
  const clear = button('Forget all', forget);
  const made = element('div', {class: 'outcome'},
    element('h3', {}, 'fixes.yaml'), file,
    element('div', {class: 'tools'}, load, clear),
    element('p', {class: 'meta'}, 'Then, in the folder that it was downloaded to:'),
    element('pre', {class: 'wrap'}, element('code', {}, command(data))),
    element('p', {class: 'meta'}, window.opener
      ? 'The page of the batch that opened this one collects it too, with those of the other objects.'
      : 'Only what the fixes touch runs again; they stay with the run until drape run gets --fixes none.'));
  made.update = () => {
    file.firstChild.textContent = fixes.empty ? '# nothing yet' : fixes.file;
    load.disabled = clear.disabled = fixes.empty;
  };
  made.update();
  return made;
}

export function startMending(root, model, data) {
  const fixes = new Fixes(data.object);
  const overlay = model && new PoseOverlay(model);
  const pad = new PhotoPad((P, photo, width, height) => overlay?.render(P, photo, width, height));
  const shared = {fixes, model, data, redraw: () => pad.draw()};
  const tools = {
    pose: new PoseTool(shared),
    points: new PointsTool(shared),
    box: new BoxTool(shared),
    click: new ClickTool(shared),
    strokes: new StrokesTool(shared),
    segments: new SegmentsTool(shared),
  };
  const names = {
    pose: 'Pose', points: 'Point pairs', box: 'Box', click: 'Point inside', strokes: 'Strokes', segments: 'Segments',
  };
  const hint = element('p', {class: 'hint'});
  const side = element('div', {class: 'side'});
  const bar = element('div', {class: 'tools'});
  let photo = data.photos[0];
  let chosen = null;

  const drop = element('input', {
    type: 'checkbox',
    onchange: () => fixes.set(photo.name, 'drop', drop.checked ? true : undefined),
  });
  const show = (key) => {
    chosen = key;
    const tool = tools[key];
    tool.start(photo);
    hint.textContent = tool.hint;
    side.replaceChildren(tool.panel());
    pad.show(photo, tool);
  };
  const open = (index) => {
    photo = data.photos[index];
    drop.checked = fixes.of(photo.name).drop === true;
    const there = Object.keys(tools).filter((key) => tools[key].available?.(photo) ?? true);
    const first = there.includes(chosen) ? chosen : there[0];
    bar.replaceChildren(
      choice('What to put right', there.map((key) => [key, names[key]]), first, show),
      element('label', {class: 'check'}, drop, 'Leave this photo out'));
    show(first);
  };
  const result = outcome(fixes, data, () => {
    for (const tool of Object.values(tools)) tool.forget?.();
    fixes.clear();
    open(data.photos.indexOf(photo));
  });
  fixes.changed = () => {
    result.update();
    window.opener?.postMessage({kind: 'drape-fixes', object: data.object, photos: structuredClone(fixes.photos)}, '*');
  };
  root.append(...[
    element('h2', {}, 'Put it right'),
    element('p', {class: 'summary'},
      'Nothing here changes the run: what you choose is collected in a file, with which drape runs again just what it touches.'),
    data.photos.length > 1
      ? choice('Photo', data.photos.map((each, i) => [String(i), each.name]), '0', (key) => open(Number(key)))
      : null,
    bar, hint, element('div', {class: 'bench'}, pad.canvas, side), result,
  ].filter(Boolean));
  root.hidden = false;
  document.querySelector('nav a[href="#result"]')?.parentElement.after(
    element('li', {}, element('a', {href: '#mend'}, 'Put it right')));
  open(0);
  return {fixes, tools, pad};
}
