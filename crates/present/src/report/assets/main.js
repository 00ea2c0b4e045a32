
// Figures, and the start of everything.

/** Figures are made for two columns of a journal; here a wide one fills the page, and letters are as large in all. */
const enlarged = 1.7;

async function showFigures() {
    const place = document.getElementById("figure-list");
    for (const picture of report.pictures) {
        const image = element("img", { alt: picture.caption });
        image.src = URL.createObjectURL(new Blob([await inflate(picture.svg)], { type: "image/svg+xml" }));
        await image.decode();
        image.width = Math.round(enlarged * image.naturalWidth);
        place?.append(element("figure", {}, image, element("figcaption", {}, picture.caption)));
    }
}

if (typeof DecompressionStream === "undefined") {
    tell("This browser cannot unpack the data of this page: it needs Chromium 80, Firefox 113 or Safari 16.4, or newer.");
} else {
    Promise.all([showFigures(), showCharts(), showMaps()]).then(() => (document.documentElement.dataset.ready = "yes"));
}
