// Fills the elements that site/preprocess.py made of formulas. KaTeX comes with the head of the page.
document.addEventListener("DOMContentLoaded", () => {
    for (const element of document.querySelectorAll(".formula")) {
        katex.render(element.dataset.tex, element, { displayMode: element.tagName === "DIV", throwOnError: false });
    }
});
