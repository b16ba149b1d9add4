// What a page is told: a header, and blocks of numbers in base64, little-endian.

const KINDS = { f4: Float32Array, u2: Uint16Array, u4: Uint32Array };

/** {type, base64} anywhere in the header becomes a typed array. */
export function decoded(value) {
  if (Array.isArray(value)) return value.map(decoded);
  if (value === null || typeof value !== "object") return value;
  if (typeof value.base64 === "string") return block(value);
  return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, decoded(inner)]));
}

function block({ type, base64 }) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; k++) bytes[k] = text.charCodeAt(k);
  return new KINDS[type](bytes.buffer);
}
