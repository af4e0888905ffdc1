'use strict';
// The sliders of the interaction classes.

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

// One slider for each class of the model. A slider of a class with a curve shows the weight in the
// current frame, and sets a point there.
function showSliders(classes, changed) {
  const sliders = classes.map((name) => {
    const slider = makeSlider(name, -1, 1);
    joinSlider(slider, (weight) => {
      if (curveOf(settings, name).length > 0) setPoint(settings, name, frameNow(), weight);
      else settings.labels[name] = weight;
      changed(`weight of ${name.replaceAll('_', ' ')}`);
    });
    return slider;
  });
  element('labels').replaceChildren(...sliders);
  followFrame();
}

// Shows the weights in the current frame, except in the field that the visitor fills in.
function followFrame() {
  for (const label of element('labels').children) {
    const {name} = label.querySelector('input');
    const isCurved = curveOf(settings, name).length > 0;
    label.classList.toggle('curved', isCurved);
    const weight = rounded(weightAt(settings, name, frameNow()), 2);
    for (const input of label.querySelectorAll('input')) {
      if (document.activeElement !== input || input.type === 'range') input.value = weight;
    }
  }
}

// Adds a point to the curve of every class in the current frame, with the weight that it has there.
function keyAll(classes) {
  const frame = frameNow();
  for (const [name, weight] of Object.entries(weightsAt(settings, classes, frame))) {
    setPoint(settings, name, frame, rounded(weight, 2));
  }
}
