/* What the page shows and how it is drawn: pictures, zoom, the values under the pointer. */
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);

/** An element with properties and children. */
function el(tag, properties, ...children) {
  const e = Object.assign(document.createElement(tag), properties);
  e.append(...children);
  return e;
}

const kinds = ['reference', 'candidate', 'difference'];
const views = [
  {id: 'side', name: 'Side by side', key: 's', needs: ['reference', 'candidate']},
  {id: 'slider', name: 'Slider', key: 'l', needs: ['reference', 'candidate']},
  {id: 'flicker', name: 'Flicker', key: 'f', needs: ['reference', 'candidate']},
  {id: 'difference', name: 'Difference', key: 'd', needs: ['difference']},
  {id: 'reference', name: 'Reference', key: '1', needs: ['reference']},
  {id: 'candidate', name: 'Candidate', key: '2', needs: ['candidate']},
];
const FLICKER_MS = 500; // below three flashes a second
const ZOOM_MAX = 128;
const PIXEL_SCALE = 6; // from here on single pixels can be told apart

/* Failures first; otherwise the order of the run. */
const cases = data.cases.map((c, i) => [c, i])
  .sort((a, b) => b[0].failed - a[0].failed || a[1] - b[1]).map(pair => pair[0]);

/* What is shown. scale: screen pixels per picture pixel, null: all of it fits; x, y: the point of the
   picture in the middle. All of it can stand in the address: #case=NAME&view=slider&scale=8&at=30. */
const state = {case: null, view: 'side', scale: null, x: 0, y: 0, at: 50, frame: true, probe: null,
               filter: cases.some(c => c.failed) ? 'failed' : 'all'};
let pictures = {};   // of the case: kind -> {image, width, height, maxval, values}
let flicker = false; // the candidate's turn
let timer = 0;

/* ---- Pictures ------------------------------------------------------------------------------- */

function decode(url) {
  return new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error('a picture of the report cannot be decoded'));
    image.src = url;
  });
}

async function load(source) {
  const picture = {image: await decode(source.src), width: source.width, height: source.height,
                   maxval: source.maxval};
  if (source.values) picture.valuesImage = await decode(source.values);
  return picture;
}

function bytesOf(image) {
  const canvas = el('canvas', {width: image.naturalWidth, height: image.naturalHeight});
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height).data;
}

/** The three values of a pixel as its file holds them, null outside. */
function valuesAt(picture, x, y) {
  if (!picture || x < 0 || y < 0 || x >= picture.width || y >= picture.height) return null;
  if (!picture.bytes) picture.bytes = bytesOf(picture.valuesImage || picture.image);
  const bytes = picture.bytes;
  if (!picture.valuesImage) {
    const i = 4 * (y * picture.image.naturalWidth + x);
    return [bytes[i], bytes[i + 1], bytes[i + 2]];
  }
  // Twelve bytes of three floats in four pixels, of which only red, green and blue are used.
  const view = new DataView(new ArrayBuffer(12));
  const first = 4 * (y * picture.image.naturalWidth + x);
  for (let i = 0; i < 12; i++)
    view.setUint8(i, bytes[4 * (first + Math.floor(i / 3)) + i % 3]);
  return [0, 4, 8].map(i => view.getFloat32(i, true));
}

const show = (v, picture) => picture.maxval ? String(v) : Number(v.toPrecision(6)).toString();

/* ---- Drawing -------------------------------------------------------------------------------- */

function shownKinds() {
  if (state.view === 'side') return kinds.filter(k => pictures[k]);
  if (state.view === 'slider') return ['slider'];
  if (state.view === 'flicker') return [flicker ? 'candidate' : 'reference'];
  return [state.view];
}

function build() {
  const stage = $('stage');
  const names = shownKinds();
  fitStage(names.length);
  stage.replaceChildren(...names.map(kind => {
    const pane = el('div', {className: 'pane'}, el('canvas', {}));
    pane.dataset.kind = kind;
    const tag = (text, side) => pane.append(el('span', {className: 'tag ' + side, textContent: text}));
    tag(kind === 'slider' ? 'reference' : kind, 'left');
    if (kind === 'slider') tag('candidate', 'right');
    listen(pane.firstChild);
    return pane;
  }));
  draw();
}

/* As high as one picture needs at full width, whatever the view, so that nothing below moves; several
   pictures share that in as many columns as show them largest. */
function fitStage(count) {
  const stage = $('stage'), {width, height} = extent();
  const room = stage.clientWidth;
  const tall = Math.round(Math.max(240, Math.min(room * height / width, innerHeight * 0.62)));
  const scale = columns =>
    Math.min(room / columns / width, tall / Math.ceil(count / columns) / height);
  let best = 1;
  for (let columns = 2; columns <= count; columns++)
    if (scale(columns) > scale(best)) best = columns;
  stage.style.height = tall + 'px';
  stage.style.gridTemplateColumns = `repeat(${best}, minmax(0, 1fr))`;
}

function panes() {
  return [...$('stage').children].map(p => ({pane: p, kind: p.dataset.kind, canvas: p.firstChild}));
}

/** Of all pictures that share the zoom: the difference has a scale below it. */
function extent() {
  const all = kinds.map(k => pictures[k]).filter(p => p);
  return {width: Math.max(1, ...all.map(p => p.image.naturalWidth)),
          height: Math.max(1, ...all.map(p => p.image.naturalHeight))};
}

/** The transform in use: scale and middle, of a canvas of that size. */
function place(width, height) {
  const size = extent();
  if (state.scale !== null) return {scale: state.scale, x: state.x, y: state.y};
  let scale = Math.min(width / size.width, height / size.height);
  if (scale > 1) scale = Math.floor(scale); // whole pixels stay sharp
  return {scale, x: size.width / 2, y: size.height / 2};
}

function drawPicture(context, picture, at, width, height, ratio) {
  if (!picture) return;
  context.setTransform(ratio * at.scale, 0, 0, ratio * at.scale,
    Math.round(ratio * (width / 2 - at.x * at.scale)), Math.round(ratio * (height / 2 - at.y * at.scale)));
  context.imageSmoothingEnabled = at.scale < 1;
  context.drawImage(picture.image, 0, 0);
}

function drawBox(context, box, at, width, height, color, gap) {
  const x = width / 2 + (box.x - at.x) * at.scale - gap, y = height / 2 + (box.y - at.y) * at.scale - gap;
  for (const [stroke, line] of [['#000', 4], [color, 2]]) {
    context.strokeStyle = stroke;
    context.lineWidth = line;
    context.strokeRect(x, y, box.width * at.scale + 2 * gap, box.height * at.scale + 2 * gap);
  }
}

/** The frame of the worst region, and that of the pixel whose values are shown. */
function drawFrames(context, at, width, height, ratio) {
  const region = current().compare?.regions?.[0];
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  if (region && state.frame) drawBox(context, region, at, width, height, '#ffd84d', 3);
  if (state.probe && at.scale >= PIXEL_SCALE)
    drawBox(context, {...state.probe, width: 1, height: 1}, at, width, height, '#fff', 1);
}

function drawPane({kind, canvas}) {
  const width = canvas.clientWidth, height = canvas.clientHeight, ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext('2d');
  const at = place(width, height);
  if (kind !== 'slider') {
    drawPicture(context, pictures[kind], at, width, height, ratio);
  } else {
    const split = width * state.at / 100;
    const half = (picture, from, to) => {
      context.save();
      context.beginPath();
      context.rect(from * ratio, 0, (to - from) * ratio, height * ratio);
      context.clip();
      drawPicture(context, picture, at, width, height, ratio);
      context.restore();
    };
    half(pictures.reference, 0, split);
    half(pictures.candidate, split, width);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = '#000';
    context.fillRect(split - 2, 0, 4, height);
    context.fillStyle = '#fff';
    context.fillRect(split - 1, 0, 2, height);
  }
  drawFrames(context, at, width, height, ratio);
}

function draw() {
  if ($('viewer').hidden || !$('stage').firstChild) return;
  panes().forEach(drawPane);
  const {canvas} = panes()[0];
  const scale = place(canvas.clientWidth, canvas.clientHeight).scale;
  $('zoom').textContent = Math.round(scale * 100) + ' %';
  for (const canvas of document.querySelectorAll('#stage canvas'))
    canvas.style.touchAction = state.scale === null && state.view !== 'slider' ? 'pan-y' : 'none';
  $('split').classList.toggle('off', state.view !== 'slider');
  $('at').value = state.at;
  drawValues();
}

function drawValues() {
  const rows = [];
  const line = (name, text) => rows.push(el('span', {textContent: name}), el('span', {textContent: text}));
  const at = state.probe;
  if (at) {
    line('pixel', at.x + ', ' + at.y);
    const values = {};
    for (const kind of ['reference', 'candidate']) {
      values[kind] = valuesAt(pictures[kind], at.x, at.y);
      if (values[kind])
        line(kind, values[kind].map(v => show(v, pictures[kind])).join('  '));
    }
    const {reference: r, candidate: c} = values;
    if (r && c && pictures.reference.maxval === pictures.candidate.maxval)
      line('change', c.map((v, i) => show(v - r[i], pictures.candidate)).join('  '));
  } else {
    line('pixel', 'move the pointer over a picture');
  }
  $('values').replaceChildren(...rows);
}

/* ---- Zoom and pointer ----------------------------------------------------------------------- */

function zoomTo(scale, fixed) {
  const {canvas} = panes()[0];
  const width = canvas.clientWidth, height = canvas.clientHeight;
  const old = place(width, height);
  const p = fixed || {x: width / 2, y: height / 2}; // stays where it is on the screen
  const pictureX = old.x + (p.x - width / 2) / old.scale, pictureY = old.y + (p.y - height / 2) / old.scale;
  state.scale = Math.min(ZOOM_MAX, Math.max(0.05, scale));
  state.x = pictureX - (p.x - width / 2) / state.scale;
  state.y = pictureY - (p.y - height / 2) / state.scale;
  draw();
}

function zoomBy(factor, fixed) {
  const {canvas} = panes()[0];
  zoomTo(place(canvas.clientWidth, canvas.clientHeight).scale * factor, fixed);
}

function showRegion(region) {
  const {canvas} = panes()[0];
  const room = 0.5 * Math.min(canvas.clientWidth / region.width, canvas.clientHeight / region.height);
  const [x, y] = region.worst_at;
  const large = room < 4; // then its worst pixel tells more than all of it
  state.scale = large ? 8 : Math.min(32, Math.floor(room));
  state.x = large ? x + 0.5 : region.x + region.width / 2;
  state.y = large ? y + 0.5 : region.y + region.height / 2;
  state.probe = {x, y};
  draw();
}

function listen(canvas) {
  const pointers = new Map();
  let dragging = '';
  const point = event => {
    const box = canvas.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  };
  const probe = p => {
    const at = place(canvas.clientWidth, canvas.clientHeight);
    const x = Math.floor(at.x + (p.x - canvas.clientWidth / 2) / at.scale);
    const y = Math.floor(at.y + (p.y - canvas.clientHeight / 2) / at.scale);
    if (state.probe?.x === x && state.probe?.y === y) return;
    state.probe = {x, y};
    if (at.scale >= PIXEL_SCALE) draw();
    else drawValues();
  };
  canvas.addEventListener('pointerdown', event => {
    const p = point(event);
    pointers.set(event.pointerId, p);
    canvas.setPointerCapture(event.pointerId);
    const near = Math.abs(p.x - canvas.clientWidth * state.at / 100) < 24;
    dragging = state.view === 'slider' && (near || state.scale === null) ? 'split' : 'pan';
    probe(p);
  });
  canvas.addEventListener('pointermove', event => {
    const p = point(event), old = pointers.get(event.pointerId);
    probe(p);
    if (!old) return;
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(old.x - other.x, old.y - other.y);
      const after = Math.hypot(p.x - other.x, p.y - other.y);
      if (before > 0) zoomBy(after / before, {x: (p.x + other.x) / 2, y: (p.y + other.y) / 2});
    } else if (dragging === 'split') {
      state.at = Math.min(100, Math.max(0, 100 * p.x / canvas.clientWidth));
      draw();
    } else if (state.scale !== null) {
      state.x -= (p.x - old.x) / state.scale;
      state.y -= (p.y - old.y) / state.scale;
      draw();
    }
    pointers.set(event.pointerId, p);
  });
  for (const name of ['pointerup', 'pointercancel'])
    canvas.addEventListener(name, event => { pointers.delete(event.pointerId); remember(); });
  canvas.addEventListener('wheel', event => {
    event.preventDefault();
    zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.002)), point(event));
  }, {passive: false});
  canvas.addEventListener('dblclick', event => zoomBy(4, point(event)));
}
