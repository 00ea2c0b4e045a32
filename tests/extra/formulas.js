// node formulas.js KATEX PAGE...: KaTeX understands every formula in the pages of the site.
const fs = require("fs");
const [katexFile, ...pages] = process.argv.slice(2);
const katex = require(katexFile);
const entities = { amp: "&", lt: "<", gt: ">", quot: '"' };

/** What a browser reads for a name or a number of a character. */
function character(entity, hexadecimal, decimal, name) {
    if (name) return entities[name] ?? entity;
    return String.fromCodePoint(hexadecimal ? parseInt(hexadecimal, 16) : Number(decimal));
}

let count = 0;
let failed = 0;
for (const page of pages) {
    for (const [, text] of fs.readFileSync(page, "utf8").matchAll(/data-tex="([^"]*)"/g)) {
        const tex = text.replace(/&(?:#x([0-9a-f]+)|#([0-9]+)|([a-z]+));/gi, character);
        count += 1;
        try {
            katex.renderToString(tex, { throwOnError: true, displayMode: true });
        } catch (error) {
            failed += 1;
            console.log(`${page}: ${tex}: ${error.message}`);
        }
    }
}
console.log(`${count} formulas, ${failed} that KaTeX does not understand`);
process.exit(failed > 0 || count < 100 ? 1 : 0);
