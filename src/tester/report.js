/* Around the pictures: the case, the list of all, the address, keys. */
/* ---- The case ------------------------------------------------------------------------------- */

const current = () => cases[state.case];
const available = view => view.needs.every(kind => pictures[kind]);

function setView(id) {
  const view = views.find(v => v.id === id);
  if (!view || !available(view)) return;
  state.view = id;
  clearInterval(timer);
  flicker = false;
  if (id === 'flicker')
    timer = setInterval(() => { flicker = !flicker; swap(); }, FLICKER_MS);
  for (const button of $('views').children)
    button.setAttribute('aria-pressed', button.dataset.view === id);
  build();
  remember();
}

/* The other picture in the same pane: what has the pointer keeps it. */
function swap() {
  const pane = $('stage').firstChild;
  const kind = flicker ? 'candidate' : 'reference';
  pane.dataset.kind = kind;
  pane.querySelector('.tag').textContent = kind;
  draw();
}

function mark(c) {
  const style = c.failed ? 'bad' : c.outcome === 'passed' ? 'good' : c.outcome === 'not run' ? 'muted' : 'note';
  return el('span', {className: 'mark ' + style, textContent: c.outcome});
}

function fillMetrics(c) {
  const number = v => v === undefined ? '∞' : Number(v.toPrecision(5)).toString();
  const rows = (c.compare?.metrics || []).map(m => {
    let value = number(m.value), limit = (m.at_least ? '≥ ' : '≤ ') + number(m.limit);
    if (m.pixels !== undefined) {
      value = number(m.value) + ' % (' + m.pixels + ' px)';
      limit = '≤ ' + number(m.allowed_percent) + ' %' + (m.limit === undefined ? '' : ' beyond ' + number(m.limit));
    }
    return el('tr', {}, el('td', {textContent: m.name}), el('td', {textContent: value}),
      el('td', {textContent: limit}),
      el('td', {className: m.pass ? 'good' : 'bad', textContent: m.pass ? 'within' : 'beyond'}));
  });
  const head = el('tr', {}, ...['Metric', 'Value', 'Limit', ''].map(t => el('th', {textContent: t})));
  const size = s => s ? s.join(' × ') : '';
  const extra = (name, value) =>
    el('tr', {}, el('td', {className: 'muted', textContent: name}), el('td', {colSpan: 3, textContent: value}));
  if (c.compare) {
    const {size: a, candidate_size: b} = c.compare;
    rows.push(extra('size', size(a) + (size(a) === size(b) ? '' : ', candidate ' + size(b))));
    if (c.compare.compared !== undefined)
      rows.push(extra('differing', c.compare.different_pixels + ' of ' + c.compare.compared + ' pixels'));
  }
  rows.push(extra('time', c.seconds.toFixed(2) + ' s'));
  $('metrics').replaceChildren(head, ...rows);
}

function fillRegions(c) {
  const regions = c.compare?.regions || [];
  $('where').hidden = regions.length === 0;
  const count = c.compare?.region_count || 0;
  const word = count === 1 ? 'One region' : count + ' regions';
  $('regions').replaceChildren(
    el('p', {textContent: word + (count > regions.length ? ', the worst ' + regions.length : '') + ':'}),
    ...regions.map(r => el('button', {
      textContent: r.width + ' × ' + r.height + ' at ' + r.x + ', ' + r.y,
      onclick: () => showRegion(r),
      disabled: $('viewer').hidden,
    })));
}

function fillCommands(c) {
  const rows = [['Command', c.command], ['Run again', c.rerun], ['Accept', c.accept],
                ['Golden', c.golden], ['Candidate', c.candidate]].filter(row => row[1]);
  $('commands').replaceChildren(...rows.map(([name, text]) => {
    const code = el('code', {textContent: text});
    const copy = el('button', {textContent: 'Copy', onclick: async () => {
      try {
        await navigator.clipboard.writeText(text);
        copy.textContent = 'Copied';
        setTimeout(() => { copy.textContent = 'Copy'; }, 1200);
      } catch { // not allowed for pages from files everywhere: the next best thing
        getSelection().selectAllChildren(code);
      }
    }});
    copy.style.minWidth = '76px';
    return el('div', {}, el('dt', {textContent: name}), el('dd', {}, code), copy);
  }));
}

function fillOrigin(c) {
  const golden = c.golden_stamp, candidate = c.candidate_stamp;
  const row = (name, a, b) => a || b ? [el('tr', {}, el('td', {className: 'muted', textContent: name}),
    ...[a, b].map(t => el('td', {}, el('code', {textContent: t || '–'}))))] : [];
  $('origin').replaceChildren(
    el('tr', {}, ...['', 'Golden', 'Candidate'].map(t => el('th', {textContent: t}))),
    ...row('software', golden.software, candidate.software),
    ...row('scene', golden.scene_sha256, candidate.scene_sha256),
    ...row('settings', golden.settings, candidate.settings),
    ...row('pixels', golden.pixels_sha256, candidate.pixels_sha256),
    ...row('device', '', c.device), ...row('driver', '', c.driver));
  $('origin').parentElement.hidden = $('origin').rows.length === 1;
}

async function select(index, keep) {
  state.case = index;
  const c = current();
  if (!keep) Object.assign(state, {scale: null, probe: null});
  clearInterval(timer);
  document.title = c.name + ' – lavaray test';
  const badge = mark(c);
  badge.classList.add('badge');
  $('name').replaceChildren(c.name, badge);
  const sentence = t => (/^[a-z]+ /.test(t) ? t[0].toUpperCase() + t.slice(1) : t) + // but no paths
    (/[.!?]$/.test(t) ? '' : '.');
  $('words').replaceChildren(...[c.message, c.cause, c.staleness].filter(t => t)
    .map(t => el('p', {textContent: sentence(t)})));
  for (const button of $('list').querySelectorAll('button')) {
    const here = button.dataset.index === String(index);
    button.setAttribute('aria-current', here);
    if (here) button.scrollIntoView({block: 'nearest'});
  }
  pictures = {};
  $('viewer').hidden = !c.pictures || Object.keys(c.pictures).length === 0;
  $('nothing').hidden = !$('viewer').hidden;
  $('nothing').textContent = c.failed ? 'There is no picture to show.' :
    'Pictures of cases that pass are in the report with --embed-all.';
  fillMetrics(c);
  fillRegions(c);
  fillCommands(c);
  fillOrigin(c);
  $('said').hidden = !c.output;
  $('output').textContent = c.output || '';
  if ($('viewer').hidden) return remember();
  const loaded = await Promise.all(kinds.filter(k => c.pictures[k])
    .map(async kind => [kind, await load(c.pictures[kind])]));
  if (state.case !== index) return; // another one was chosen meanwhile
  pictures = Object.fromEntries(loaded);
  for (const button of $('views').children)
    button.disabled = !available(views.find(v => v.id === button.dataset.view));
  $('worst').disabled = !c.compare?.regions?.length;
  const wanted = views.find(v => v.id === state.view);
  setView((available(wanted) ? wanted : views.find(available)).id);
}

function step(by) {
  const shown = [...$('list').querySelectorAll('button')].map(b => Number(b.dataset.index));
  if (shown.length === 0) return;
  const at = shown.indexOf(state.case);
  select(shown[at < 0 ? 0 : (at + by + shown.length) % shown.length]);
}

/* ---- List and address ----------------------------------------------------------------------- */

function fillList() {
  for (const button of $('filters').children)
    button.setAttribute('aria-pressed', button.dataset.filter === state.filter);
  $('list').replaceChildren(...cases.flatMap((c, i) => {
    if (state.filter === 'failed' && !c.failed) return [];
    const button = el('button', {onclick: () => select(i)}, el('span', {textContent: c.name}), mark(c));
    button.dataset.index = i;
    button.setAttribute('aria-current', i === state.case);
    return [el('li', {}, button)];
  }));
}

function remember() {
  const p = new URLSearchParams({case: current().name, view: state.view});
  if (state.view === 'slider') p.set('at', state.at.toFixed(1));
  if (state.scale !== null) {
    p.set('scale', state.scale.toFixed(3));
    p.set('x', state.x.toFixed(2));
    p.set('y', state.y.toFixed(2));
  }
  try {
    history.replaceState(null, '', '#' + p);
  } catch {
    // Some browsers refuse this for pages from files.
  }
}

async function readAddress() {
  const p = new URLSearchParams(location.hash.slice(1));
  const number = (name, fallback) => p.has(name) && isFinite(p.get(name)) ? Number(p.get(name)) : fallback;
  const index = cases.findIndex(c => c.name === p.get('case'));
  if (views.some(v => v.id === p.get('view'))) state.view = p.get('view');
  state.at = Math.min(100, Math.max(0, number('at', 50)));
  state.scale = p.has('scale') ? Math.min(ZOOM_MAX, Math.max(0.05, number('scale', 1))) : null;
  state.x = number('x', 0);
  state.y = number('y', 0);
  const probe = /^(\d+),(\d+)$/.exec(p.get('probe') || '');
  state.probe = probe ? {x: Number(probe[1]), y: Number(probe[2])} : null;
  if (index >= 0 && !cases[index].failed) state.filter = 'all';
  fillList();
  $('case').hidden = cases.length === 0; // as in a shard that got none
  if (cases.length === 0) return;
  await select(Math.max(0, index), true);
  if (p.has('worst') && current().compare?.regions?.length && !$('viewer').hidden)
    showRegion(current().compare.regions[0]);
}

function fillHeader() {
  const total = cases.length, failed = data.failures;
  $('title').textContent = data.title;
  $('verdict').textContent = failed ? failed + ' of ' + total + ' cases failed' :
    total + (total === 1 ? ' case' : ' cases') + ', none failed';
  $('verdict').className = failed ? 'bad' : 'good';
  const unique = key => [...new Set(cases.map(c => c[key]).filter(v => v))].join('; ');
  const rows = [['Device', unique('device')], ['Driver', unique('driver')], ['CPU', data.cpu],
                ['lavaray', data.version], ['Started', data.started.replace('T', ' ').replace('Z', ' UTC')],
                ['Took', data.seconds.toFixed(1) + ' s'], ['Command', data.command]];
  $('about').replaceChildren(...rows.filter(row => row[1])
    .map(([name, text]) => el('div', {}, el('dt', {textContent: name}), el('dd', {textContent: text}))));
}

function fillControls() {
  $('filters').replaceChildren(...[['failed', 'Failed ' + data.failures], ['all', 'All ' + cases.length]]
    .map(([id, name]) => {
      const button = el('button', {textContent: name, onclick: () => { state.filter = id; fillList(); }});
      button.dataset.filter = id;
      return button;
    }));
  $('views').replaceChildren(...views.map(v => {
    const button = el('button', {textContent: v.name, title: v.name + ' (' + v.key + ')',
                                 onclick: () => setView(v.id)});
    button.dataset.view = v.id;
    return button;
  }));
  const zoom = (id, text, title, action) =>
    el('button', {id, textContent: text, title, onclick: () => { action(); remember(); }});
  $('zooms').replaceChildren(
    zoom('worst', 'Worst', 'Go to the worst region (w)', () => showRegion(current().compare.regions[0])),
    zoom('out', '−', 'Zoom out (−)', () => zoomBy(0.5)),
    zoom('zoom', '100 %', 'Fit (0)', () => { state.scale = null; draw(); }),
    zoom('in', '+', 'Zoom in (+)', () => zoomBy(2)));
  $('zoom').style.minWidth = '76px';
  $('out').setAttribute('aria-label', 'Zoom out');
  $('in').setAttribute('aria-label', 'Zoom in');
  $('previous').onclick = () => step(-1);
  $('next').onclick = () => step(1);
  $('at').oninput = () => { state.at = Number($('at').value); draw(); };
  $('at').onchange = remember;
}

addEventListener('keydown', event => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') {
    if (event.target === $('at')) return; // moves the divider
    step(event.key === 'ArrowLeft' ? -1 : 1);
  } else if ($('viewer').hidden || !$('stage').firstChild) {
    return;
  } else if (views.some(v => v.key === event.key)) {
    setView(views.find(v => v.key === event.key).id);
  } else if (['w', '+', '=', '-', '0'].includes(event.key)) {
    $({w: 'worst', '-': 'out', '0': 'zoom'}[event.key] || 'in').click();
  } else if (event.key === 'b') {
    state.frame = !state.frame;
    draw();
  } else {
    return;
  }
  event.preventDefault();
});
addEventListener('resize', () => { if ($('stage').firstChild && !$('viewer').hidden) build(); });
addEventListener('hashchange', readAddress);

fillHeader();
fillControls();
readAddress().then(() => { document.documentElement.dataset.state = 'ready'; });
