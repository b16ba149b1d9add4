// Curves of equal energy on the momentum sphere, for principal inertias (Playter 1994, section 2.5).
//
// A direction n of unit length has the energy e = n1²/I1 + n2²/I2 + n3²/I3 (2T/h²). About the axis c
// that a curve goes round, with p and q the others: n_p = r cos φ, n_q = r sin φ, n_c² = 1 − r² and
//     r² = (e − 1/I_c) / (cos² φ/I_p + sin² φ/I_q − 1/I_c).

const POINTS = 120;
const LEVELS = 4; // on each side of the separatrix

/** Both pieces of the curve of an energy e about axis c, each a list of points [n1, n2, n3]. */
export function energyCurve(inertias, e, c) {
  const [p, q] = [(c + 1) % 3, (c + 2) % 3];
  const inverse = inertias.map((inertia) => 1 / inertia);
  const pieces = [[], []];
  for (let k = 0; k <= POINTS; k++) {
    const angle = (2 * Math.PI * k) / POINTS;
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    const across = cos * cos * inverse[p] + sin * sin * inverse[q] - inverse[c];
    const squared = Math.min(1, Math.max(0, (e - inverse[c]) / across));
    const r = Math.sqrt(squared);
    const rest = Math.sqrt(1 - squared);
    pieces.forEach((piece, side) => {
      const n = [0, 0, 0];
      n[p] = r * cos;
      n[q] = r * sin;
      n[c] = side ? -rest : rest;
      piece.push(n);
    });
  }
  return pieces;
}

/** Curves round the minor and round the major axis, and the separatrix between them. */
export function energyMap(inertias) {
  const order = [0, 1, 2].sort((a, b) => inertias[a] - inertias[b]);
  const [minor, middle, major] = order;
  const spread = inertias[major] / inertias[minor] - 1;
  const map = { minor: [], major: [], separatrix: [], axes: { minor, middle, major } };
  if (spread < 1e-6) return map; // a sphere has one energy
  const differ = (a, b) => inertias[b] / inertias[a] - 1 > 1e-6 * spread;
  const levels = (other) =>
    Array.from({ length: LEVELS }, (_, k) => {
      const angle = ((k + 0.5) / LEVELS) * (Math.PI / 2);
      return Math.cos(angle) ** 2 / inertias[middle] + Math.sin(angle) ** 2 / inertias[other];
    });
  if (differ(minor, middle)) map.minor = levels(minor).flatMap((e) => energyCurve(inertias, e, minor));
  if (differ(middle, major)) map.major = levels(major).flatMap((e) => energyCurve(inertias, e, major));
  const about = map.minor.length ? minor : major;
  map.separatrix = energyCurve(inertias, 1 / inertias[middle], about);
  return map;
}
