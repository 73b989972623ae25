// What the seeds of a cell tell: mean, bias and variance of each pixel, and the error's power by frequency.

/** {count, mean, variance}: pictures; the variance is the sample's, a mean over channels, and null for one seed. */
async function seedStatistics(key) {
  const images = await seedsOf(key);
  if (images.length === 0) return null;
  const {width, height} = images[0], size = width * height, n = images.length;
  const mean = {width, height, planes: [0, 1, 2].map(() => new Float32Array(size))};
  const variance = n > 1 ? {width, height, planes: [new Float32Array(size)]} : null;
  for (let channel = 0; channel < 3; ++channel) {
    for (let i = 0; i < size; ++i) {
      let sum = 0, squares = 0;
      for (const image of images) sum += value(image, channel, i);
      const middle = sum / n;
      mean.planes[channel][i] = middle;
      if (!variance) continue;
      for (const image of images) squares += (value(image, channel, i) - middle) ** 2;
      variance.planes[0][i] += squares / (n - 1) / 3;
    }
  }
  return {count: n, mean, variance};
}

/** bias² of each pixel: (mean − r)² less what the variance of that mean and the reference's own standard error add to it, so it
 *  may fall below 0 by chance. */
function biasSquare(found, reference, own, counted) {
  return grey(reference.width, reference.height, (i) => {
    if (!counted[i]) return NaN;
    let sum = 0;
    for (let channel = 0; channel < 3; ++channel)
      sum += (value(found.mean, channel, i) - value(reference, channel, i)) ** 2 / 3;
    const ofMean = found.variance ? found.variance.planes[0][i] / found.count : 0;
    return sum - ofMean - (own ? own.planes[0][i] ** 2 : 0);
  });
}

/** |discrete Fourier transform|² of a real map over (width · height)², so that its sum is the map's mean square: row by row, then
 *  column by column. Returns real and imaginary parts. */
function transform(map, width, height) {
  const turns = (n) => [Float64Array.from({length: n}, (_, k) => Math.cos((2 * Math.PI * k) / n)),
    Float64Array.from({length: n}, (_, k) => Math.sin((2 * Math.PI * k) / n))];
  const [cosX, sinX] = turns(width), [cosY, sinY] = turns(height);
  const re = new Float64Array(width * height), im = new Float64Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let u = 0; u < width; ++u) {
      let a = 0, b = 0;
      for (let x = 0, k = 0; x < width; ++x, k = (k + u) % width) { const v = map[y * width + x]; a += v * cosX[k]; b -= v * sinX[k]; }
      re[y * width + u] = a / width;
      im[y * width + u] = b / width;
    }
  }
  const columnRe = new Float64Array(height), columnIm = new Float64Array(height);
  for (let u = 0; u < width; ++u) {
    for (let v = 0; v < height; ++v) {
      let a = 0, b = 0;
      for (let y = 0, k = 0; y < height; ++y, k = (k + v) % height) {
        const p = re[y * width + u], q = im[y * width + u];
        a += p * cosY[k] + q * sinY[k];
        b += q * cosY[k] - p * sinY[k];
      }
      columnRe[v] = a / height;
      columnIm[v] = b / height;
    }
    for (let v = 0; v < height; ++v) { re[v * width + u] = columnRe[v]; im[v * width + u] = columnIm[v]; }
  }
  return {re, im};
}

/** The error's power by frequency over the seeds [Celarek et al. 2019], of the mean over channels: rings of frequencies, each
 *  {frequency [1/pixel], total, variance, bias2}; the totals of all rings add up to the mean square error. */
async function errorSpectrum(key, rings = 24) {
  const reference = await referencePicture(errorLayer()), images = await seedsOf(key);
  if (!reference || images.length === 0) return null;
  const {width, height} = reference, size = width * height, n = images.length;
  const counted = await countedPixels([key]);
  const spectra = images.map((image) => {
    const error = new Float64Array(size);
    for (let i = 0; i < size; ++i) if (counted[i])
      for (let channel = 0; channel < 3; ++channel) error[i] += (value(image, channel, i) - value(reference, channel, i)) / 3;
    return transform(error, width, height);
  });
  const found = Array.from({length: rings}, () => ({frequency: 0, total: 0, variance: 0, count: 0}));
  for (let v = 0; v < height; ++v) {
    for (let u = 0; u < width; ++u) {
      const i = v * width + u;
      const f = Math.hypot(Math.min(u, width - u) / width, Math.min(v, height - v) / height);
      const ring = found[Math.min(rings - 1, Math.floor((f / Math.SQRT1_2) * rings))];
      let total = 0, re = 0, im = 0;
      for (const each of spectra) { total += (each.re[i] ** 2 + each.im[i] ** 2) / n; re += each.re[i] / n; im += each.im[i] / n; }
      ring.total += total;
      if (n > 1) ring.variance += ((total - re * re - im * im) * n) / (n - 1);
      ring.frequency += f;
      ++ring.count;
    }
  }
  return found.filter((ring) => ring.count > 0).map((ring) => ({frequency: ring.frequency / ring.count, total: ring.total,
    variance: n > 1 ? ring.variance : null, bias2: n > 1 ? ring.total - ring.variance : null}));
}

/** Least squares through the logarithms: {slope, error (standard, or null for two points)}. */
function fittedSlope(points) {
  const logs = points.filter((point) => point.x > 0 && point.y > 0).map((point) => [Math.log(point.x), Math.log(point.y)]);
  const n = logs.length;
  if (n < 2) return null;
  const mx = logs.reduce((sum, [x]) => sum + x, 0) / n, my = logs.reduce((sum, [, y]) => sum + y, 0) / n;
  let sxx = 0, sxy = 0;
  for (const [x, y] of logs) { sxx += (x - mx) ** 2; sxy += (x - mx) * (y - my); }
  if (!(sxx > 0)) return null;
  const slope = sxy / sxx;
  if (n === 2) return {slope, error: null};
  let rest = 0;
  for (const [x, y] of logs) rest += (y - my - slope * (x - mx)) ** 2;
  return {slope, error: Math.sqrt(rest / (n - 2) / sxx)};
}
