
// What every page needs: its JSON document, numbers, elements, colours, and a place for problems.
"use strict";

const report = JSON.parse(document.getElementById("data").textContent);

/** A number with so many digits, with a true minus. */
function readable(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    const size = Math.abs(value);
    const text = size !== 0 && (size < 1e-4 || size >= 1e7) ? value.toExponential(digits - 1).replace(/\.?0*e\+?/, "e") : String(Number(value.toPrecision(digits)));
    return text.replaceAll("-", "−");
}

/** An element with attributes or properties, and what is in it. */
function element(name, properties = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(properties)) {
        if (key in made && !key.startsWith("aria")) made[key] = value;
        else made.setAttribute(key, value);
    }
    made.append(...children);
    return made;
}

const darkness = matchMedia("(prefers-color-scheme: dark)");
let printing = false;

/** Colours for the present scheme; paper is light. */
function scheme() {
    const dark = darkness.matches && !printing;
    return {
        ink: dark ? "#e6eaec" : "#1d2327",
        line: dark ? "#3a4349" : "#d5dadd",
        empty: dark ? "#2a3237" : "#e9ecee",
        runs: dark
            ? ["#6cbcf0", "#ff9d5c", "#4fd6a5", "#e79cc9", "#ffd24d", "#b3a1ff", "#9fd356", "#c9c9c9"]
            : ["#0072b2", "#d55e00", "#008a63", "#b0468c", "#a67c00", "#5b4bc4", "#5a7d0c", "#666666"],
    };
}

/** Calls `draw` whenever colours change. */
function onScheme(draw) {
    darkness.addEventListener("change", draw);
    addEventListener("beforeprint", () => ((printing = true), draw()));
    addEventListener("afterprint", () => ((printing = false), draw()));
}

function tell(problem) {
    const place = document.getElementById("problem");
    place.hidden = false;
    place.textContent = problem;
}

addEventListener("error", (event) => tell(`This page does not work here: ${event.message}`));
addEventListener("unhandledrejection", (event) => tell(`This page does not work here: ${event.reason}`));
