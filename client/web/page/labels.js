'use strict';
// The sliders of the interaction classes, and the key frames made from them.

// A slider and a number field for the same value.
function makeSlider(name, least, most) {
  const label = document.createElement('label');
  label.className = 'slider';
  const text = name.replaceAll('_', ' ');
  const range = Object.assign(document.createElement('input'),
                              {type: 'range', min: least, max: most, step: 0.05, name});
  const field = Object.assign(document.createElement('input'),
                              {type: 'number', min: -MAX_WEIGHT, max: MAX_WEIGHT, step: 0.05});
  field.setAttribute('aria-label', `${text}, exactly`);
  label.append(Object.assign(document.createElement('span'), {textContent: text}), range, field);
  return label;
}

// Keeps slider and field equal; calls `set` with the visitor's values.
function joinSlider(label, set) {
  const [range, field] = label.querySelectorAll('input');
  for (const input of [range, field]) {
    input.addEventListener('input', (event) => {
      event.stopPropagation();
      if (input.value === '' || !input.checkValidity()) return;
      const other = input === range ? field : range;
      other.value = input.value;
      set(Number(input.value));
    });
  }
}

function setSlider(label, value) {
  for (const input of label.querySelectorAll('input')) input.value = value;
}

// One slider for each class of the model.
function showSliders(classes, changed) {
  const sliders = classes.map((name) => {
    const slider = makeSlider(name, -1, 1);
    setSlider(slider, settings.labels[name] ?? 0);
    joinSlider(slider, (weight) => {
      settings.labels[name] = weight;
      changed();
    });
    return slider;
  });
  element('labels').replaceChildren(...sliders);
}

function setLabels(weights) {
  settings.labels = {...weights};
  for (const label of element('labels').children) {
    setSlider(label, weights[label.querySelector('input').name] ?? 0);
  }
}

function describeWeights(weights) {
  const parts = Object.entries(weights).filter(([, weight]) => weight !== 0)
      .map(([name, weight]) => `${name.replaceAll('_', ' ')} ${weight}`);
  return parts.join(', ') || 'neutral';
}

function showKeyframes(changed) {
  const items = settings.keyframes.map(({frame, weights}) => {
    const item = document.createElement('li');
    addButton(item, `frame ${frame}: ${describeWeights(weights)}`, () => {
      seekAll(frame);
      setLabels(weights);
      changed();
    });
    const remove = addButton(item, '×', () => {
      settings.keyframes = settings.keyframes.filter((key) => key.frame !== frame);
      showKeyframes(changed);
      changed();
      element('add-key').focus();
    });
    remove.className = 'remove';
    remove.setAttribute('aria-label', `Remove the key frame at ${frame}`);
    return item;
  });
  element('keyframes').replaceChildren(...items);
  element('add-key').textContent = items.length ? 'Add or replace the key frame here'
                                                : 'Add a key frame here';
  if (items.length) element('keys').open = true;
}

function connectKeyframes(changed) {
  element('add-key').addEventListener('click', () => {
    addKeyframe(Math.round(theatre.player.frame), {...settings.labels});
    showKeyframes(changed);
    changed();
  });
}
