// Error maps of any pair: x the picture, r what it is held against; a pixel's value is a mean over its three channels.

const FORMULAS = {
  signed: {text: "x − r", unit: "W m⁻² sr⁻¹", signed: true, of: (x, r) => x - r},
  absolute: {text: "|x − r|", unit: "W m⁻² sr⁻¹", of: (x, r) => Math.abs(x - r)},
  square: {text: "(x − r)²", unit: "(W m⁻² sr⁻¹)²", of: (x, r) => (x - r) ** 2},
  relative: {text: "|x − r| / (r + ε mean(r))", unit: "1", epsilon: true, of: (x, r, e) => Math.abs(x - r) / (r + e)},
  signed_relative: {text: "(x − r) / (r + ε mean(r))", unit: "1", signed: true, epsilon: true, of: (x, r, e) => (x - r) / (r + e)},
  relative_square: {text: "(x − r)² / (r² + ε mean(r)²)", unit: "1", epsilon: true, squared: true, of: (x, r, e) => (x - r) ** 2 / (r * r + e)},
  symmetric: {text: "|x − r| / (|x| + |r| + ε mean(r))", unit: "1", epsilon: true, of: (x, r, e) => Math.abs(x - r) / (Math.abs(x) + Math.abs(r) + e)},
};

/** Mean over the counted pixels and all channels. */
function meanOf(image, counted) {
  let sum = 0, count = 0;
  for (let i = 0; i < counted.length; ++i) {
    if (!counted[i]) continue;
    for (let channel = 0; channel < 3; ++channel) sum += value(image, channel, i);
    count += 3;
  }
  return count ? sum / count : NaN;
}

/** The map of a formula over a pair; NaN where a pixel is not counted. */
function errorMap(x, r, name, epsilon, counted) {
  const formula = FORMULAS[name];
  const mean = formula.epsilon ? meanOf(r, counted) : 0;
  const e = epsilon * (formula.squared ? mean * mean : mean);
  return grey(x.width, x.height, (i) => {
    if (!counted[i]) return NaN;
    let sum = 0;
    for (let channel = 0; channel < 3; ++channel) sum += formula.of(value(x, channel, i), value(r, channel, i), e);
    return sum / 3;
  });
}

/** Mean of a map over a region [x0, y0, x1, y1] (ends included), or over all; pixels not counted are left out. */
function meanOfMap(map, region) {
  let sum = 0, count = 0;
  forRegion(map, region, (i) => {
    const each = map.planes[0][i];
    if (!Number.isNaN(each)) { sum += each; ++count; }
  });
  return {mean: count ? sum / count : NaN, count};
}

function forRegion(image, region, visit) {
  const [x0, y0, x1, y1] = region ?? [0, 0, image.width - 1, image.height - 1];
  for (let y = Math.max(0, y0); y <= Math.min(image.height - 1, y1); ++y)
    for (let x = Math.max(0, x0); x <= Math.min(image.width - 1, x1); ++x) visit(y * image.width + x);
}

function formulaText() {
  const formula = FORMULAS[state.formula];
  return formula.epsilon ? `${formula.text}, ε = ${state.epsilon}` : formula.text;
}
