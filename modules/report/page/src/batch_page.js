// The page of a batch: sorting, finding, and the fixes of all objects in one file.
import {button, choice, element} from './dom.js';
import {download, fixesFile} from './fixes.js';

const table = document.getElementById('objects');
const rows = [...table.tBodies[0].rows];

function sortBy(column, header) {
  const descending = header.getAttribute('aria-sort') === 'ascending';
  for (const each of table.tHead.rows[0].cells) each.removeAttribute('aria-sort');
  header.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
  const value = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent;
  const numbers = rows.every((row) => value(row) === '' || !Number.isNaN(Number(value(row))));
  rows.sort((a, b) => numbers
    ? Number(value(a)) - Number(value(b))
    : value(a).localeCompare(value(b), 'en', {numeric: true}));
  if (descending) rows.reverse();
  table.tBodies[0].append(...rows);
}

for (const [column, header] of [...table.tHead.rows[0].cells].entries()) {
  const text = header.textContent;
  header.replaceChildren(element('button', {type: 'button', class: 'sort', onclick: () => sortBy(column, header)}, text));
}

// Which rows are shown.
let wanted = 'all';
let words = '';
const found = element('span', {class: 'meta', role: 'status'});

function filter() {
  let shown = 0;
  for (const row of rows) {
    const hit = (wanted === 'all' || row.dataset.status === wanted) && row.textContent.toLowerCase().includes(words);
    row.hidden = !hit;
    shown += hit ? 1 : 0;
  }
  found.textContent = shown === rows.length ? '' : `${shown} of ${rows.length}`;
}

const statuses = ['failed', 'missing', 'review', 'ok'].filter((status) => rows.some((row) => row.dataset.status === status));
document.getElementById('filters').append(
  choice('Show', [['all', 'All'], ...statuses.map((status) => [status, status])], 'all', (key) => {
    wanted = key;
    filter();
  }),
  element('input', {
    type: 'search',
    placeholder: 'Find…',
    'aria-label': 'Find objects',
    oninput: (event) => {
      words = event.target.value.toLowerCase();
      filter();
    },
  }), found);

// What the objects' own pages, opened from here, send.
const fixes = new Map();
const outcome = document.getElementById('fixes');
const file = element('pre', {class: 'wrap'}, element('code'));
const load = button('Download fixes.yaml', () => download(content()), {class: 'main', id: 'download-fixes'});

function content() {
  return fixes.size > 0 ? fixesFile([...fixes.values()]) : 'fixes: []\n';
}

function show() {
  load.disabled = fixes.size === 0;
  file.firstChild.textContent = fixes.size > 0 ? content() : '# nothing yet: open an object’s page from here and put it right there';
  for (const row of rows) row.classList.toggle('mended', fixes.has(row.dataset.object));
}

outcome.prepend(file, element('div', {class: 'tools'}, load));
window.addEventListener('message', ({data}) => {
  if (data?.kind !== 'drape-fixes' || !rows.some((row) => row.dataset.object === data.object)) return;
  if (Object.keys(data.photos).length > 0) fixes.set(data.object, {object: data.object, photos: data.photos});
  else fixes.delete(data.object);
  show();
});
document.getElementById('fixes-card').hidden = false;
show();
