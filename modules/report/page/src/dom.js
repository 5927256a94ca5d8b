// Small helpers for building the page's controls.

/** An element with attributes and children; `on...` attributes are listeners. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, '');
    else if (value !== false && value != null) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child != null));
  return made;
}

/** A labelled range input; `change` gets its number. */
export function slider(label, {min, max, step = 1, value, unit = ''}, change) {
  const shown = element('output', {}, `${value}${unit}`);
  const input = element('input', {type: 'range', min, max, step, value, 'aria-label': label});
  input.addEventListener('input', () => {
    shown.textContent = `${input.value}${unit}`;
    change(Number(input.value));
  });
  const made = element('label', {class: 'slider'}, element('span', {}, label), input, shown);
  made.set = (number) => {
    input.value = number;
    shown.textContent = `${input.value}${unit}`;
  };
  made.input = input;
  return made;
}

/** A group of buttons of which one is pressed; `change` gets its key. */
export function choice(label, entries, chosen, change) {
  const buttons = new Map();
  const made = element('div', {class: 'choice', role: 'group', 'aria-label': label});
  made.choose = (key) => {
    for (const [name, button] of buttons) button.setAttribute('aria-pressed', String(name === key));
  };
  for (const [key, text, title] of entries) {
    const button = element('button', {
      type: 'button',
      title,
      'data-key': key,
      onclick: () => {
        made.choose(key);
        change(key);
      },
    }, text);
    buttons.set(key, button);
    made.append(button);
  }
  made.choose(chosen);
  return made;
}

export function button(text, action, attributes = {}) {
  return element('button', {type: 'button', onclick: action, ...attributes}, text);
}

/** The embedded picture with this key, or nothing. */
export function picture(key) {
  return key ? document.querySelector(`img[data-key="${CSS.escape(key)}"]`) : null;
}
