// Pictures: deflated half floats in base64, decoded when they are first shown.

const HALVES = (() => { // the value of every half float
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24
      : exponent === 31 ? (fraction ? NaN : Infinity) : (1 + fraction / 1024) * 2 ** (exponent - 15);
    values[bits] = bits & 0x8000 ? -size : size;
  }
  return values;
})();

const decodedPictures = new Map();

/** Picture number `id` of the page: {width, height, planes: [Float32Array]}; one promise for each. */
function picture(id) {
  if (!decodedPictures.has(id)) decodedPictures.set(id, decode(id));
  return decodedPictures.get(id);
}

/** The text of a picture, as soon as the file is read that far: pictures are the last of it, those shown first before the others. */
function textOf(id) {
  return new Promise((done) => {
    const look = () => {
      const element = byId(`p${id}`);
      if (element && (element.nextElementSibling || document.readyState !== "loading")) done(element.textContent);
      else setTimeout(look, 10);
    };
    look();
  });
}

async function decode(id) {
  const about = page.pictures[id];
  const text = await textOf(id);
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = about.width * about.height, count = size * about.planes, factor = 2 ** -about.scale;
  const bits = (plane, i) => bytes[plane * size + i] | (bytes[plane * size + i + count] << 8);
  const planes = [];
  for (let plane = 0; plane < about.planes; ++plane) { // of three, red and blue are steps from green
    const step = about.planes === 3 && plane !== 1;
    planes.push(Float32Array.from({length: size}, (_, i) => HALVES[(bits(plane, i) + (step ? bits(1, i) : 0)) & 65535] * factor));
  }
  return {width: about.width, height: about.height, planes};
}

/** The layer that maps, probe, distribution and spectrum are of: the indirect light where that is shown, else the caustic. */
function errorLayer() { return state.layer === "indirect" ? "indirect" : "caustic"; }
function ownErrorLayer() { return errorLayer() === "caustic" ? "stderr" : "indirect_stderr"; }

/** The error column of a cell that belongs to that layer. */
function layerError(cell) { return cell.errors[errorLayer() === "caustic" ? "rmse" : "indirect_rmse"]; }

/** A layer of a key of the shown scene at one of its seeds: a picture, or {hole: reason}. */
async function layerOf(key, name = errorLayer(), seed = Number(state.seed), where = scene()) {
  const found = key === REFERENCE ? referenceLayer(name, where) : pictureLayer(pictureOf(key, seed, where), name);
  return found.hole ? found : picture(found.id);
}

/** {id} of a layer of a cell's picture, or {hole: reason}. */
function pictureLayer(found, name) {
  if (found.hole) return found;
  if (found[name] === undefined) return {hole: `its picture has no layer ${name}`};
  return typeof found[name] === "object" ? found[name] : {id: found[name]};
}

/** What is kept of a cell's picture: {seed, trial, hash, command, caustic}, or with `hole` in place of `caustic`. */
function pictureOf(key, seed = Number(state.seed), where = scene()) {
  const cell = where.cells[Number(key)];
  if (!cell) return {hole: "no such cell"};
  return cell.pictures[Math.min(seed, cell.pictures.length - 1)] ?? {hole: "no picture"};
}

function referenceLayer(name, where = scene()) {
  const reference = where.reference;
  if (!reference) return {hole: "the sweep has no reference"};
  if (reference.hole) return {hole: reference.hole};
  const id = reference.layers[name];
  if (id === undefined) return {hole: `the reference has no layer ${name}`};
  return typeof id === "object" ? id : {id};
}

/** A layer of the reference, decoded, or null. */
async function referencePicture(name, where = scene()) {
  const found = referenceLayer(name, where);
  return found.hole ? null : picture(found.id);
}

/** 1 where the metrics count a pixel, for some keys together: reached by the reference and by each picture. */
async function countedPixels(keys, where = scene()) {
  const size = where.width * where.height;
  const counted = new Uint8Array(size).fill(1);
  const masks = [await referencePicture("unreached", where)];
  for (const key of keys) {
    if (key === REFERENCE) continue;
    const id = pictureOf(key, Number(state.seed), where).unreached;
    if (typeof id === "number") masks.push(await picture(id));
  }
  for (const mask of masks) if (mask) for (let i = 0; i < size; ++i) if (mask.planes[0][i] > 0) counted[i] = 0;
  return counted;
}

/** Every seed's picture of a cell, of the layer that errors are of; seeds without one are left out. */
async function seedsOf(key, where = scene()) {
  const found = where.cells[Number(key)].pictures.map((each) => pictureLayer(each, errorLayer()));
  return Promise.all(found.filter((each) => !each.hole).map((each) => picture(each.id)));
}

/** The value of channel 0 to 2 at a pixel; equal channels are kept once. */
function value(image, channel, at) { return image.planes[image.planes.length === 1 ? 0 : channel][at]; }

function luminance(image, at) {
  return 0.2126 * value(image, 0, at) + 0.7152 * value(image, 1, at) + 0.0722 * value(image, 2, at);
}

/** A map as a picture of one plane. */
function grey(width, height, make) {
  const plane = new Float32Array(width * height);
  for (let i = 0; i < plane.length; ++i) plane[i] = make(i);
  return {width, height, planes: [plane]};
}
