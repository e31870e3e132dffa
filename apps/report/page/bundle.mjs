// Makes the page's one file: main.js with all it imports, the style sheet and page.html; run by ../bundle.sh.
//
//     node bundle.mjs OUTPUT.html
//
// The page's security policy admits this very script by its hash and nothing else, so that no text of a record can ever run.
import {createHash} from "node:crypto";
import {readFileSync, readdirSync, writeFileSync} from "node:fs";
import {build} from "esbuild";

const sha256 = (text, encoding) => createHash("sha256").update(text).digest(encoding);

const {outputFiles} = await build({
  entryPoints: ["main.js"], bundle: true, minify: true, charset: "ascii", target: "es2022", legalComments: "eof", write: false, outdir: "out",
});
const output = (extension) => outputFiles.find((file) => file.path.endsWith(extension)).text.replaceAll("</script", "<\\/script");
const script = output(".js"), style = output(".css");

// What the page was made from: `name hash` of each source, in order, hashed together. tests/report_sources.cmake does the same.
const sources = readdirSync(".").filter((name) => /\.(js|css|html|mjs|json)$/.test(name) && name !== "package-lock.json").sort();
const digest = sha256(sources.map((name) => `${name} ${sha256(readFileSync(name), "hex")}\n`).join(""), "hex");

const pieces = {PAGE_STYLE: style, PAGE_SCRIPT: script, SCRIPT_HASH: `sha256-${sha256(script, "base64")}`};
const page = readFileSync("page.html", "utf8").replace(/PAGE_STYLE|PAGE_SCRIPT|SCRIPT_HASH/g, (name) => pieces[name]);
writeFileSync(process.argv[2], page.replace("<head>", `<head>\n<!-- made by apps/report/bundle.sh from sources ${digest} -->`));
console.log(`${process.argv[2]}: ${page.length} bytes`);
