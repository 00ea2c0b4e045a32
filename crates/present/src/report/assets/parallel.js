
// Runs as lines over axes side by side: filtered by dragging along axes, coloured by any of them, read by pointing.

/** Distance from a line at which it is read, pixels. */
const near = 10;
/** What arrow keys move, as a part of an axis. */
const step = 0.05;

class Parallel {
    constructor(svg) {
        this.svg = svg;
        this.lines = [...svg.querySelectorAll(".lines path")];
        this.shown = report.axes.map(() => null);
        this.coloured = report.coloured;
        this.reading = document.getElementById("parallel-reading");
        this.key = document.getElementById("parallel-key");
        this.brushes = [...svg.querySelectorAll(".axis")].map((axis, index) => this.arm(axis, index));
        this.addControls(document.getElementById("parallel-controls"));
        svg.addEventListener("pointermove", (event) => this.point(event));
        svg.addEventListener("pointerleave", () => this.read(null));
        this.filter();
    }

    addControls(place) {
        this.reset = element("button", { type: "button", id: "parallel-reset", onclick: () => this.clear() }, "Show all runs");
        this.count = element("output", { id: "parallel-count" });
        const choice = element("select", {}, ...report.axes.map((axis, index) => new Option(axis.name, index)));
        choice.value = this.coloured ?? 0;
        choice.addEventListener("change", () => this.colour(Number(choice.value)));
        const label = element("label", {}, "Colour", choice);
        place.append(this.reset, ...(this.coloured === null ? [] : [label]), this.count);
    }

    /** Makes an axis respond; gives the rectangle that shows what is chosen on it. */
    arm(axis, index) {
        const [top, bottom] = report.ends;
        const hit = drawn("rect", { class: "hit", x: -20, y: top - 12, width: 40, height: bottom - top + 24 });
        const brush = drawn("rect", { class: "brush", x: -8, width: 16, visibility: "hidden" });
        axis.append(hit, brush);
        axis.setAttribute("tabindex", 0);
        axis.setAttribute("role", "group");
        let from = null;
        hit.addEventListener("pointerdown", (event) => {
            if (event.button !== 0) return;
            from = this.part(event);
            hit.setPointerCapture(event.pointerId);
            event.preventDefault();
            axis.focus({ preventScroll: true });
        });
        hit.addEventListener("pointermove", (event) => {
            if (from === null) return;
            const to = this.part(event);
            // A click is no choice.
            this.choose(index, Math.abs(to - from) > 0.01 ? [Math.min(from, to), Math.max(from, to)] : null);
        });
        hit.addEventListener("pointerup", (event) => {
            if (from !== null && Math.abs(this.part(event) - from) <= 0.01) this.choose(index, null);
            from = null;
        });
        hit.addEventListener("pointercancel", () => (from = null));
        axis.addEventListener("keydown", (event) => this.press(event, index));
        return brush;
    }

    /** Where on an axis a pointer is: 0 at the lower end, 1 at the upper one. */
    part(event) {
        const [top, bottom] = report.ends;
        const y = this.place(event)[1];
        return Math.min(1, Math.max(0, (bottom - y) / (bottom - top)));
    }

    /** Where a pointer is in the drawing. */
    place(event) {
        const box = this.svg.getBoundingClientRect();
        const { width, height } = this.svg.viewBox.baseVal;
        return [((event.clientX - box.left) / box.width) * width, ((event.clientY - box.top) / box.height) * height];
    }

    press(event, index) {
        const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        if (event.key === "Escape") this.choose(index, null);
        else if (!direction) return;
        else {
            let [low, high] = this.shown[index] ?? (direction > 0 ? [0, 0.25] : [0.75, 1]);
            if (this.shown[index] && event.shiftKey) high = Math.min(1, Math.max(low + step, high + direction * step));
            else if (this.shown[index]) {
                const move = Math.min(1 - high, Math.max(-low, direction * step));
                [low, high] = [low + move, high + move];
            }
            this.choose(index, [low, high]);
        }
        event.preventDefault();
    }

    choose(index, interval) {
        this.shown[index] = interval;
        this.filter();
    }

    clear() {
        this.shown.fill(null);
        this.filter();
    }

    /** Where a run lies on an axis; nothing where it has no value. */
    height(run, index) {
        const value = report.runs[run][index];
        const { low, high } = report.axes[index];
        return value === null ? null : (value - low) / (high - low);
    }

    isShown(run) {
        // Values at the ends of an interval are in it, though they are rounded.
        return this.shown.every((interval, index) => {
            const part = interval && this.height(run, index);
            return !interval || (part !== null && part >= interval[0] - 1e-6 && part <= interval[1] + 1e-6);
        });
    }

    /** Shows the runs that are within all that is chosen. */
    filter() {
        const [top, bottom] = report.ends;
        let count = 0;
        this.lines.forEach((line, run) => {
            const shown = this.isShown(run);
            line.classList.toggle("out", !shown);
            count += shown;
        });
        this.brushes.forEach((brush, index) => {
            const interval = this.shown[index];
            brush.setAttribute("visibility", interval ? "visible" : "hidden");
            if (!interval) return;
            brush.setAttribute("y", bottom - interval[1] * (bottom - top));
            brush.setAttribute("height", Math.max(1, (interval[1] - interval[0]) * (bottom - top)));
        });
        this.reset.disabled = this.shown.every((interval) => !interval);
        this.count.textContent = `${count} of ${this.lines.length} runs`;
        this.svg.dataset.shown = count;
        this.read(null);
    }

    /** Colours lines by their places on an axis. */
    colour(index) {
        this.coloured = index;
        this.lines.forEach((line, run) => {
            const part = this.height(run, index);
            const colour = part === null ? "none" : `c${Math.min(report.colours - 1, Math.floor(part * report.colours))}`;
            line.setAttribute("class", colour);
        });
        const axis = report.axes[index];
        const [name, low, , high] = this.key.children;
        name.textContent = axis.name;
        low.textContent = valueText(axis, axis.low, 4);
        high.textContent = valueText(axis, axis.high, 4);
        this.filter();
    }

    /** Reads the line next to the pointer. */
    point(event) {
        if (event.buttons) return;
        const [x, y] = this.place(event);
        const [top, bottom] = report.ends;
        const right = report.places.findIndex((place) => place >= x);
        if (right < 1 && report.places[0] !== x) return this.read(null);
        const left = Math.max(0, right - 1);
        const [from, to] = [report.places[left], report.places[right]];
        const along = to > from ? (x - from) / (to - from) : 0;
        let [best, least] = [null, near];
        for (let run = 0; run < this.lines.length; run++) {
            const [one, other] = [this.height(run, left), this.height(run, right)];
            if (one === null || other === null || !this.isShown(run)) continue;
            const distance = Math.abs(bottom - (one + along * (other - one)) * (bottom - top) - y);
            if (distance < least) [best, least] = [run, distance];
        }
        this.read(best);
    }

    read(run) {
        if (this.last !== undefined && this.last !== null) this.lines[this.last].classList.remove("read");
        this.last = run;
        if (run === null) {
            this.reading.textContent = "Point at a line to read its run.";
            return;
        }
        this.lines[run].classList.add("read");
        const values = report.axes.map((axis, index) => `${axis.name} ${valueText(axis, report.runs[run][index])}`);
        this.reading.textContent = `Run ${run + 1}: ${values.join(", ")}`;
    }
}

/** A value on an axis in words. */
function valueText(axis, value, digits = 6) {
    if (value === null) return "–";
    const text = axis.levels.length ? (axis.levels[Math.round(value)] ?? "–") : readable(value, digits);
    return `${text} ${axis.unit}`.trim();
}

/** A part of the drawing. */
function drawn(name, attributes) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
}

new Parallel(document.getElementById("parallel"));
document.documentElement.dataset.ready = "yes";
