#pragma once
/// @file What a page does.

#include <string_view>

namespace freepath {

/// Before anything is shown: errors are counted, and the theme that was chosen is set, so that the
/// page does not flash in another. `?theme=dark` in the address outweighs the choice.
inline constexpr std::string_view kPageFirstScript = R"js(
(() => {
  'use strict';
  const root = document.documentElement;
  root.classList.add('js');
  root.dataset.errors = '0';
  const count = () => { root.dataset.errors = String(Number(root.dataset.errors) + 1); };
  window.addEventListener('error', count, true);
  window.addEventListener('unhandledrejection', count);
  let theme = new URLSearchParams(location.search).get('theme');
  try { theme = theme || localStorage.getItem('freepath-theme'); } catch { /* not remembered */ }
  if (theme === 'light' || theme === 'dark') root.dataset.theme = theme;
})();
)js";

/// Once all is there.
inline constexpr std::string_view kPageScript = R"js(
(() => {
  'use strict';
  const root = document.documentElement;
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

  const startTheme = () => {
    const button = document.querySelector('.theme');
    const order = ['auto', 'light', 'dark'];
    const show = () => {
      const theme = root.dataset.theme || 'auto';
      button.querySelector('span').textContent = theme[0].toUpperCase() + theme.slice(1);
      button.setAttribute('aria-label', 'Colours: ' + theme);
    };
    button.addEventListener('click', () => {
      const next = order[(order.indexOf(root.dataset.theme || 'auto') + 1) % order.length];
      if (next === 'auto') delete root.dataset.theme; else root.dataset.theme = next;
      try { localStorage.setItem('freepath-theme', next); } catch { /* not remembered */ }
      show();
    });
    show();
  };

  // The section that is being read is marked in the contents.
  const startContents = () => {
    const nav = document.querySelector('.contents');
    const links = new Map(all('a', nav).map(link => [link.getAttribute('href').slice(1), link]));
    const mark = id => {
      for (const [key, link] of links) {
        if (key === id) link.setAttribute('aria-current', 'true');
        else link.removeAttribute('aria-current');
      }
      const link = links.get(id);
      nav.scrollLeft = link.offsetLeft - nav.offsetLeft - nav.clientWidth / 2 + link.clientWidth / 2;
    };
    const observer = new IntersectionObserver(entries => {
      for (const entry of entries) if (entry.isIntersecting) mark(entry.target.id);
    }, {rootMargin: '-15% 0px -75% 0px'});
    all('main section[id]').forEach(section => observer.observe(section));
  };

  // Upwards, downwards, and then as it was. Cells without a number stay below.
  const startTables = () => {
    for (const table of all('table')) {
      const body = table.tBodies[0];
      const original = [...body.rows];
      const heads = [...table.tHead.rows[0].cells];
      heads.forEach((head, column) => head.querySelector('button').addEventListener('click', () => {
        const now = head.getAttribute('aria-sort');
        const next = {ascending: 'descending', descending: null}[now];
        const order = next === undefined ? 'ascending' : next;
        heads.forEach(other => other.removeAttribute('aria-sort'));
        if (order) head.setAttribute('aria-sort', order);
        const sign = order === 'descending' ? -1 : 1;
        const key = row => {
          const cell = row.cells[column];
          return cell.dataset.number === undefined ? cell.firstChild?.textContent ?? ''
                                                   : Number(cell.dataset.number);
        };
        const compare = (a, b) => {
          if (typeof a === 'string') {
            return sign * a.localeCompare(b, undefined, {numeric: true});
          }
          if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
          return a === b ? 0 : sign * (a < b ? -1 : 1);
        };
        const rows = order ? [...original].sort((a, b) => compare(key(a), key(b))) : original;
        body.append(...rows);
      }));
    }
  };

  const startCopying = () => {
    for (const button of all('.copy')) {
      const code = button.parentElement.querySelector('code');
      const say = text => {
        button.textContent = text;
        setTimeout(() => { button.textContent = 'Copy'; }, 1500);
      };
      button.addEventListener('click', async () => {
        try {
          await navigator.clipboard.writeText(code.textContent);
          say('Copied');
        } catch {  // not allowed: the reader can copy what is selected
          getSelection().selectAllChildren(code);
          say('Selected');
        }
      });
    }
  };

  // Two pictures, a seam between them, and a view onto both: shift and zoom in units of the stage.
  const startViewer = viewer => {
    const get = selector => viewer.querySelector(selector);
    const stage = get('.stage');
    const seam = get('.seam');
    const selects = [get('.choose-left'), get('.choose-right')];
    const images = [get('.layer.left img'), get('.layer.right img')];
    const tags = [get('.layer.left .tag'), get('.layer.right .tag')];
    const sources = all('.picture-grid img', viewer);
    const width = Number(viewer.dataset.width);
    const height = Number(viewer.dataset.height);
    const view = {x: 0, y: 0, zoom: 1};

    const showPictures = () => selects.forEach((select, side) => {
      const source = sources[select.selectedIndex];
      images[side].src = source.src;
      images[side].alt = tags[side].textContent = source.alt;
    });
    const showSeam = () => stage.style.setProperty('--seam', seam.value + '%');
    const showView = () => {
      view.x = clamp(view.x, 1 - view.zoom, 0);
      view.y = clamp(view.y, 1 - view.zoom, 0);
      for (const image of images) {
        image.style.transform =
            `translate(${view.x * 100}%, ${view.y * 100}%) scale(${view.zoom})`;
      }
      stage.classList.toggle('zoomed-in', view.zoom > 1);
      const scale = stage.clientWidth * view.zoom / width;
      for (const image of images) image.style.imageRendering = scale < 1 ? 'auto' : 'pixelated';
      get('.scale-shown').textContent = Math.round(100 * scale) + '\u202f%';
    };
    const zoomBy = (factor, x, y) => {
      const zoom = clamp(view.zoom * factor, 1, Math.max(8, 32 * width / stage.clientWidth));
      view.x = x - (x - view.x) * zoom / view.zoom;
      view.y = y - (y - view.y) * zoom / view.zoom;
      view.zoom = zoom;
      showView();
    };
    const reset = () => { Object.assign(view, {x: 0, y: 0, zoom: 1}); showView(); };
    const positionOf = event => {
      const box = stage.getBoundingClientRect();
      return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
    };

    selects.forEach(select => select.addEventListener('change', showPictures));
    seam.addEventListener('input', showSeam);
    get('.swap').addEventListener('click', () => {
      const index = selects[0].selectedIndex;
      selects[0].selectedIndex = selects[1].selectedIndex;
      selects[1].selectedIndex = index;
      showPictures();
    });
    get('.zoom-in').addEventListener('click', () => zoomBy(1.5, 0.5, 0.5));
    get('.zoom-out').addEventListener('click', () => zoomBy(1 / 1.5, 0.5, 0.5));
    get('.zoom-reset').addEventListener('click', reset);
    stage.addEventListener('dblclick', reset);
    stage.addEventListener('wheel', event => {
      if (view.zoom === 1 && event.deltaY > 0) return;  // the page scrolls on
      event.preventDefault();
      const position = positionOf(event);
      zoomBy(Math.exp(-clamp(event.deltaY, -120, 120) / 400), position.x, position.y);
    }, {passive: false});

    // One pointer moves the seam or the pictures, two zoom.
    const pointers = new Map();
    let moves = '';
    stage.addEventListener('pointerdown', event => {
      if (event.button !== 0) return;
      pointers.set(event.pointerId, positionOf(event));
      stage.setPointerCapture(event.pointerId);
      moves = event.target.closest('.handle') || view.zoom === 1 ? 'seam' : 'view';
      stage.classList.toggle('moving', moves === 'view');
    });
    stage.addEventListener('pointermove', event => {
      const position = positionOf(event);
      const pixel = {x: Math.floor((position.x - view.x) / view.zoom * width),
                     y: Math.floor((position.y - view.y) / view.zoom * height)};
      get('.where').textContent = `x\u2009=\u2009${pixel.x}, y\u2009=\u2009${pixel.y}`;
      const before = pointers.get(event.pointerId);
      if (!before) return;
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const distance = point => Math.hypot((point.x - other.x) * width,
                                             (point.y - other.y) * height);
        zoomBy(distance(position) / Math.max(distance(before), 1e-3), other.x, other.y);
      } else if (moves === 'seam') {
        seam.value = clamp(100 * position.x, 0, 100);
        showSeam();
      } else {
        view.x += position.x - before.x;
        view.y += position.y - before.y;
        showView();
      }
      pointers.set(event.pointerId, position);
    });
    const release = event => {
      pointers.delete(event.pointerId);
      stage.classList.remove('moving');
    };
    stage.addEventListener('pointerup', release);
    stage.addEventListener('pointercancel', release);
    stage.addEventListener('pointerleave', () => { get('.where').textContent = ''; });
    new ResizeObserver(showView).observe(stage);

    if (sources.length > 1) selects[1].selectedIndex = 1;
    showPictures();
    showSeam();
    showView();
  };

  // A click on a map shows it large; the arrows go on to its neighbours.
  const startMaps = () => {
    const dialog = document.querySelector('.enlarged');
    const image = dialog.querySelector('img');
    let group = [];
    let index = 0;
    const show = () => {
      const source = group[index];
      image.src = source.src;
      image.alt = dialog.querySelector('p').textContent = source.alt;
      dialog.style.setProperty('--aspect', source.naturalWidth / source.naturalHeight);
    };
    for (const maps of all('.maps')) {
      const images = all('.enlarge img', maps);
      images.forEach((map, i) => map.parentElement.addEventListener('click', () => {
        group = images;
        index = i;
        show();
        dialog.showModal();
      }));
    }
    dialog.addEventListener('click', () => dialog.close());
    dialog.addEventListener('keydown', event => {
      const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
      if (!step) return;
      index = (index + step + group.length) % group.length;
      show();
    });
  };

  const starts = [startTheme, startTables, startCopying];
  if (document.querySelector('.contents a')) starts.push(startContents);
  if (document.querySelector('.maps')) starts.push(startMaps);
  for (const viewer of all('.viewer')) starts.push(() => startViewer(viewer));
  for (const start of starts) {
    try { start(); } catch (error) {
      root.dataset.errors = String(Number(root.dataset.errors) + 1);
      console.error(error);
    }
  }
  root.dataset.ready = 'yes';
})();
)js";

}  // namespace freepath
