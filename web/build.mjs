// Builds the one script that pages carry, with the notices of the libraries in it.
import { readFileSync, mkdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "../src/somersault/view/web");
mkdirSync(out, { recursive: true });

await build({
  absWorkingDir: here,
  entryPoints: ["src/page.js"],
  outfile: join(out, "page.js"),
  bundle: true,
  format: "iife", // browsers refuse modules from file://
  minify: true,
  charset: "ascii",
  target: "es2020",
  legalComments: "none", // they are in the notices, in full
  loader: { ".css": "text" },
  logLevel: "warning",
});

const notices = ["three", "uplot"].map((name) => {
  const { version, homepage } = JSON.parse(readFileSync(join(here, `node_modules/${name}/package.json`)));
  const licence = readFileSync(join(here, `node_modules/${name}/LICENSE`), "utf8").trim();
  return `${name} ${version}${homepage ? `, ${homepage}` : ""}\n\n${licence}\n`;
});
writeFileSync(join(out, "NOTICES.txt"), `page.js contains:\n\n${notices.join("\n---\n\n")}`);
