#include "run_page_script.hpp"

namespace talus::io {

Markup run_page_script() {
  return R"js((function () {
'use strict';
const find = id => document.getElementById(id);
const viewer = find('viewer');
if (!viewer) return;
const number = name => Number(viewer.dataset[name]);
const maps = Array.from(document.querySelectorAll('image[data-values]'));
const choices = [find('choose-a'), find('choose-b')], views = [find('view-a'), find('view-b')];
const legends = [find('legend-a'), find('legend-b')];

// Values: base64 of a zlib stream of 16-bit codes, first their low bytes, then their high bytes.
const codes = new Map();
function codesOf(map) {
  if (!codes.has(map)) {
    const packed = Uint8Array.from(atob(map.dataset.values), c => c.charCodeAt(0));
    const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    codes.set(map, new Response(plain).arrayBuffer().then(bytes => new Uint8Array(bytes)));
  }
  return codes.get(map);
}

function textOf(code, map) {
  if (code === 0) return '-';
  const share = map.dataset.unit === '1', n = code - 2;
  const digits = n % 900 + 100, exponent = Math.floor(n / 900) - 32 + (share ? 2 : 0);
  const value = code === 1 ? 0 : Number(digits + 'e' + exponent);
  if (map.dataset.classes !== undefined) {
    const named = JSON.parse(map.dataset.classes).find(one => one[0] === value);
    return named && named[1] || String(value);
  }
  const unit = map.dataset.unit === 'count' ? '' : share ? '%' : map.dataset.unit;
  return value + (unit ? ' ' + unit : '');
}

function slide() {
  const width = number('width'), at = width * find('slider').value / 1000;
  find('left-part').setAttribute('width', at + 1);
  find('right-part').setAttribute('x', at);
  find('right-part').setAttribute('width', width - at + 1);
  find('edge').setAttribute('x1', at);
  find('edge').setAttribute('x2', at);
}

function choose(side) {
  views[side].setAttribute('href', '#map-' + choices[side].value);
  legends[side].setAttribute('href', '#legend-' + choices[side].value);
}

async function show(column, row) {
  const west = number('west') + column * number('pixelX'), north = number('north') - row * number('pixelY');
  find('place').textContent = 'East ' + west.toFixed(1) + ' to ' + (west + number('pixelX')).toFixed(1) +
    ' m, north ' + (north - number('pixelY')).toFixed(1) + ' to ' + north.toFixed(1) + ' m';
  const mark = find('mark');
  mark.setAttribute('cx', (column + 0.5) * number('width') / number('columns'));
  mark.setAttribute('cy', (row + 0.5) * number('height') / number('rows'));
  mark.setAttribute('visibility', 'visible');
  const table = document.createElement('tbody'), at = row * number('columns') + column;
  for (const map of maps) {
    const bytes = await codesOf(map), line = table.insertRow();
    line.insertCell().textContent = map.dataset.title;
    line.insertCell().textContent = textOf(bytes[at] + 256 * bytes[bytes.length / 2 + at], map);
  }
  find('values').replaceChildren(table);
}

viewer.addEventListener('click', event => {
  const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(viewer.getScreenCTM().inverse());
  const column = Math.floor(place.x / number('width') * number('columns'));
  const row = Math.floor(place.y / number('height') * number('rows'));
  if (column < 0 || row < 0 || column >= number('columns') || row >= number('rows')) return;
  show(column, row).catch(() => {
    find('place').textContent = 'This browser cannot unpack the values; one of 2023 or later can.';
  });
});
find('slider').addEventListener('input', slide);
choices.forEach((choice, side) => {
  maps.forEach((map, i) => choice.add(new Option(map.dataset.title, i)));
  choice.value = Math.min(side, maps.length - 1);
  choice.addEventListener('change', () => choose(side));
  choose(side);
});
slide();
})();
)js"_html;
}

}  // namespace talus::io
