// From values to colours: the tone curve of a screen, and false colours whose lightness orders them without their hue.

function srgb(linear) {
  const x = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

/** Red, green and blue of 0 to 1: a helix round the grey line (Green 2011), so that lightness rises all the way. */
function sequential(t) {
  const angle = 2 * Math.PI * (0.15 + 0.9 * t), swing = 0.75 * t * (1 - t);
  const cos = Math.cos(angle), sin = Math.sin(angle);
  return [t + swing * (-0.14861 * cos + 1.78277 * sin), t + swing * (-0.29227 * cos - 0.90649 * sin),
    t + swing * 1.97294 * cos].map((x) => Math.round(255 * Math.min(1, Math.max(0, x))));
}

/** Of −1 to 1: blue below, orange above, dark at zero; the signs are also on the scale and on enlarged pixels. */
function diverging(t) {
  const x = Math.min(1, Math.abs(t)), bright = Math.sqrt(x);
  const colour = t < 0 ? [0.35 * x, 0.72 * bright, 1 * bright] : [1 * bright, 0.62 * bright, 0.18 * x];
  return colour.map((part) => Math.round(20 + 235 * Math.min(1, part)));
}

/** How values become colours: {signed, log, low, high}, to [0, 1] or to [−1, 1]. */
function place(value, range) {
  if (range.signed) return Math.max(-1, Math.min(1, value / range.high));
  if (range.log) return value <= 0 ? 0 : Math.min(1, Math.max(0, Math.log(value / range.low) / Math.log(range.high / range.low)));
  return Math.min(1, Math.max(0, (value - range.low) / (range.high - range.low)));
}

/** Paints a picture of radiance, or a map by false colours, at one pixel a pixel; pixels that are not counted are greyed. */
function painted(image, exposure, range, counted) {
  const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext("2d");
  const pixels = context.createImageData(image.width, image.height), size = image.width * image.height;
  const factor = 2 ** exposure;
  for (let i = 0; i < size; ++i) {
    let colour;
    if (!range) colour = [0, 1, 2].map((channel) => srgb(factor * value(image, channel, i)));
    else {
      const shown = image.planes.length === 1 ? image.planes[0][i] : luminance(image, i);
      colour = Number.isNaN(shown) ? [128, 128, 128] : range.signed ? diverging(place(shown, range)) : sequential(place(shown, range));
    }
    if (counted && !counted[i]) colour = colour.map((part) => Math.round(0.3 * part + ((i + Math.floor(i / image.width)) % 4 < 2 ? 96 : 70)));
    pixels.data.set([...colour, 255], 4 * i);
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

/** The exposure [stops] at which the 99th percentile of luminance over lit pixels is white, as `render` chooses it. */
function usualExposure(image) {
  const lit = [];
  for (let i = 0; i < image.width * image.height; ++i) { const y = luminance(image, i); if (y > 0) lit.push(y); }
  if (lit.length === 0) return 0;
  lit.sort((a, b) => a - b);
  return -Math.log2(lit[Math.min(lit.length - 1, Math.floor(0.99 * lit.length))]);
}

/** A range that holds all but the outermost half percent of the maps' values. */
function usualRange(maps, signed, log) {
  const sizes = [];
  for (const map of maps) for (const x of map.planes[0]) if (x !== 0 && !Number.isNaN(x)) sizes.push(Math.abs(x));
  if (sizes.length === 0) return {signed, log, low: signed ? -1 : 0, high: 1};
  sizes.sort((a, b) => a - b);
  const high = sizes[Math.floor(0.995 * (sizes.length - 1))] || 1;
  const low = signed ? -high : log ? Math.min(high / 10, Math.max(high * 1e-4, sizes[Math.floor(0.05 * sizes.length)])) : 0;
  return {signed, log: log && !signed, low, high};
}

/** The scale bar of a range: colours with their numbers, for the screen and for SVG. */
function scaleBar(range, width, unit) {
  const height = 34, steps = 64, parts = [];
  for (let i = 0; i < steps; ++i) {
    const t = (i + 0.5) / steps, colour = range.signed ? diverging(2 * t - 1) : sequential(t);
    parts.push(make("rect", {x: (i * width) / steps, y: 0, width: width / steps + 0.6, height: 12, fill: `rgb(${colour})`}));
  }
  const ticks = range.signed ? [[0, -range.high], [0.5, 0], [1, range.high]]
    : range.log ? [[0, range.low], [0.5, Math.sqrt(range.low * range.high)], [1, range.high]]
      : [[0, range.low], [0.5, (range.low + range.high) / 2], [1, range.high]];
  for (const [t, number] of ticks) {
    const anchor = t === 0 ? "start" : t === 1 ? "end" : "middle";
    const sign = range.signed && number > 0 ? "+" : t === 0 && !range.signed && !range.log ? "" : t === 0 && range.log ? "≤ " : "";
    parts.push(make("text", {x: t * width, y: 25, "text-anchor": anchor, class: "tick"}, `${sign}${short(number, 3)}`));
  }
  const bar = make("svg", {class: "scale", width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
    "aria-label": `colours from ${short(range.low, 3)} to ${short(range.high, 3)} ${unit}`}, ...parts);
  return bar;
}
