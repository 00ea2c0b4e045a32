
// Figures, and the start of everything.

/** Figures are made for two columns of a journal; here a wide one fills the page, and letters are as large in all. */
const enlarged = 1.7;

/** The ground, letters and axes of a figure in the colours of a dark page; maps and data keep theirs. */
const onDark = '<style>rect[fill="#FFFFFF"] { fill: #14181b } [fill="#222222"] { fill: #e6eaec } [stroke="#222222"] { stroke: #e6eaec }</style>';

function asImage(svg) {
    return URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
}

/** A narrow screen shows charts and maps, which fit it; figures are folded there, but printed. */
function foldFigures() {
    const fold = document.getElementById("figure-fold");
    if (!fold) return;
    fold.open = !matchMedia("(max-width: 40rem)").matches;
    let wasOpen = fold.open;
    addEventListener("beforeprint", () => ((wasOpen = fold.open), (fold.open = true)));
    addEventListener("afterprint", () => (fold.open = wasOpen));
}

async function showFigures() {
    foldFigures();
    const place = document.getElementById("figure-list");
    for (const picture of report.pictures) {
        const image = element("img", { className: "on-light", alt: picture.caption });
        const svg = new TextDecoder().decode(await inflate(picture.svg));
        // One of them is shown: paper is white, whatever the page is.
        const dark = element("img", { className: "on-dark", alt: picture.caption });
        dark.src = asImage(svg.replace(/^<svg[^>]*>/, `$&${onDark}`));
        image.src = asImage(svg);
        await image.decode();
        image.width = dark.width = Math.round(enlarged * image.naturalWidth);
        place?.append(element("figure", {}, image, dark, element("figcaption", {}, picture.caption)));
    }
}

if (typeof DecompressionStream === "undefined") {
    tell("This browser cannot unpack the data of this page: it needs Chromium 80, Firefox 113 or Safari 16.4, or newer.");
} else {
    Promise.all([showFigures(), showCharts(), showMaps()]).then(() => (document.documentElement.dataset.ready = "yes"));
}
