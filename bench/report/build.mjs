// Bundles src/ into template.html: one file with everything in it but the results, which the bench puts where the mark stands.
// node build.mjs [OUTPUT] [default: template.html]. The same bytes for the same sources and package-lock.json.
import { readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const output = process.argv[2] ?? here("template.html");

async function bundle(entry) {
    const result = await build({
        entryPoints: [here(entry)],
        absWorkingDir: here("."),
        bundle: true,
        minify: true,
        format: "iife",
        target: ["chrome120", "firefox121", "safari17.5"],
        charset: "utf8",
        legalComments: "none",
        write: false,
    });
    return result.outputFiles[0].text;
}

function fill(page, mark, text) {
    if (page.split(mark).length !== 2) throw new Error(`src/page.html must have ${mark} once`);
    return page.split(mark).join(text);
}

const style = await bundle("src/style.css");
const script = await bundle("src/main.ts");
if (/<\/style/i.test(style)) throw new Error("the bundled style would end its element early");
if (/<\/script|<!--/i.test(script)) throw new Error("the bundled script would end its element early");

let page = await readFile(here("src/page.html"), "utf8");
page = fill(page, "/*style*/", style);
page = fill(page, "/*script*/", script);
page = fill(page, "licence-of-uplot", (await readFile(here("node_modules/uplot/LICENSE"), "utf8")).trim());
if (page.split("<!--sconce:data-->").length !== 2) throw new Error("the page must have <!--sconce:data--> once");
await writeFile(output, page);
