
// Charts of series against time.

/** Quantities that belong into one chart: name, series, and whether the axis is logarithmic at first. */
const groups = [
    ["Contact area", ["contact_area", "contact_area_mean"]],
    ["Filled fraction and coverage", ["filled_fraction", "disc_secondary", "pin_primary", "pin_secondary", "pin_none"]],
    ["Debris balance of the simulated pin", ["worn_pin", "worn_resin", "worn_disc", "deposited_pin", "deposited_disc", "emitted", "pool", "returned"]],
    ["Contact pressure", ["mean_pressure", "max_pressure"]],
    ["Coefficient of friction", ["friction_coefficient", "friction_coefficient_mean"]],
    ["Temperature", ["contact_temperature", "disc_temperature", "pin_temperature"]],
    ["Temperature of the cells of the pin", ["contact_temperature_heated", "contact_temperature_max"]],
    ["Work of friction and heat lost, of the simulated pin", ["friction_work", "heat_lost"]],
    ["Emitted and airborne mass, of the simulated pin", ["emitted_mass", "pm10_mass", "pm25_mass"]],
    ["Roughness of the disc", ["disc_sa", "disc_sq"]],
    ["Roughness of the pin", ["pin_sa", "pin_sq"]],
];
/** Residuals, and what each is called. */
const residuals = { load_residual: "Load balance", balance_residual: "Debris balance", heat_residual: "Energy balance" };
/** What fluctuates from step to step, and its mean. */
const fluctuating = [["contact_area", "contact_area_mean"], ["friction_coefficient", "friction_coefficient_mean"]];
const dashes = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 5], [14, 4], [2, 6], [1, 2]];

/** A chart with controls in `place`; `shown` tells which runs are drawn. */
class Chart {
    static all = [];

    constructor(place, choices, chosen, shown, logarithmic = false) {
        this.choices = choices;
        this.shown = shown;
        this.choice = element("select", { "aria-label": "Quantity" }, ...choices.map(([name], index) => new Option(name, index)));
        this.choice.value = chosen;
        this.logarithmic = element("input", { type: "checkbox", checked: logarithmic });
        const button = (text, label, act) => element("button", { type: "button", "aria-label": label, onclick: act }, text);
        const controls = element("div", { className: "controls" },
            this.choice,
            element("label", {}, this.logarithmic, "logarithmic"),
            element("span", {},
                button("+", "Zoom in", () => this.zoom(0.5)), " ",
                button("−", "Zoom out", () => this.zoom(2)), " ",
                button("All", "Show all times", () => this.zoomTo(null))));
        this.plot = element("div", { className: "plot", tabIndex: 0, role: "group", "aria-label": "Chart; arrow keys move the cursor" });
        this.plot.addEventListener("keydown", (event) => this.key(event));
        this.choice.addEventListener("change", () => this.draw());
        this.logarithmic.addEventListener("change", () => this.draw());
        this.values = element("div", { className: "scroll values", tabIndex: 0, role: "region", "aria-label": "Values at the cursor" });
        place.append(element("div", { className: "panel" }, controls, this.plot, this.values));
        new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(this.plot);
        Chart.all.push(this);
    }

    /** Series of the chosen group that the shown runs have, drawn anew; the zoom stays. */
    async draw() {
        const names = this.choices[Number(this.choice.value)][1];
        const turn = (this.turn = {});
        const lines = [];
        for (const [index, run] of report.runs.entries()) {
            if (!this.shown(index)) continue;
            for (const [kind, name] of names.entries()) {
                const series = run.series.find((series) => series.name === name);
                if (series) lines.push({ run, index, kind, series, points: await readSeries(run, series) });
            }
        }
        if (turn !== this.turn) return;
        const [low, high] = this.uplot ? [this.uplot.scales.x.min, this.uplot.scales.x.max] : [];
        const zoomed = this.zoomed;
        this.uplot?.destroy();
        this.lines = lines;
        this.several = new Set(lines.map((line) => line.index)).size > 1;
        this.showLegend();
        this.uplot = lines.length ? new uPlot(this.options(lines), this.data(lines), this.plot) : undefined;
        if (zoomed && this.uplot) this.uplot.setScale("x", { min: low, max: high });
        this.plot.dataset.lines = lines.length;
    }

    /** Points of all lines over the union of their times. */
    data(lines) {
        const value = (line, value) => {
            const size = this.magnitude ? Math.abs(value) : value;
            const drawn = inUnit(size, line.series.unit);
            return Number.isFinite(drawn) && !(this.logarithmic.checked && drawn <= 0) ? drawn : null;
        };
        return uPlot.join(lines.map((line) => [line.points.times, line.points.values.map((number) => value(line, number))]));
    }

    options(lines) {
        const colours = scheme();
        const unit = lines[0].series.unit;
        const axis = { stroke: colours.ink, grid: { stroke: colours.line, width: 1 }, ticks: { stroke: colours.line, width: 1 }, font: "12px system-ui, sans-serif", labelFont: "13px system-ui, sans-serif" };
        const numbers = (_, splits) => splits.map((split) => (split === null ? "" : readable(split, 6)));
        const room = (_, values) => this.logarithmic.checked ? 60 : 16 + 7 * Math.max(3, ...(values ?? []).map((text) => text?.length ?? 0));
        return {
            width: this.plot.clientWidth,
            height: this.height(),
            legend: { show: false },
            cursor: { drag: { x: true, y: false, uni: 10 }, dataIdx: nearest, points: { size: 7 } },
            hooks: { setCursor: [(chart) => this.read(chart)], setData: [(chart) => this.read(chart)] },
            scales: { x: { time: false }, y: { distr: this.logarithmic.checked ? 3 : 1 } },
            series: [{}, ...lines.map((line) => ({ ...this.style(line), width: 1.5, points: { show: line.points.times.length < 2 } }))],
            axes: [
                { ...axis, label: "time, s", labelSize: 20, size: 34, values: numbers },
                { ...axis, label: [this.title(), unit.symbol].filter(Boolean).join(", "), labelSize: 22, size: room, values: this.logarithmic.checked ? decades : numbers },
            ],
        };
    }

    /** Colours tell runs apart and dashes series; in one run colours tell series apart. */
    style(line) {
        const colours = scheme().runs;
        // Single steps fluctuate: a faint band behind their mean.
        const band = fluctuating.some(([steps]) => line.series.name === steps);
        const fluctuates = fluctuating.flat().includes(line.series.name);
        return {
            stroke: colours[(this.several ? line.index : line.kind) % colours.length],
            dash: this.several && !fluctuates ? dashes[line.kind % dashes.length] : [],
            alpha: band ? 0.4 : 1,
        };
    }

    /** A table of what the lines mean: a row for each series, a column for each run, with the values at the cursor. */
    showLegend() {
        const runs = [...new Set(this.lines.map((line) => line.index))];
        const kinds = [...new Map(this.lines.map((line) => [line.kind, line])).values()];
        this.when = element("th", { scope: "col" });
        this.cells = this.lines.map(() => element("td", {}, "–"));
        const head = (index) => {
            const line = this.lines.find((line) => line.index === index);
            return element("th", { scope: "col" }, ...(this.several ? [stroke({ ...this.style(line), dash: [], alpha: 1 }), " "] : []), line.run.label);
        };
        const row = (kind) => {
            const style = this.several ? { ...this.style(kind), stroke: scheme().ink } : this.style(kind);
            const cell = (index) => this.cells[this.lines.findIndex((line) => line.index === index && line.kind === kind.kind)] ?? element("td", {}, "–");
            return element("tr", {}, element("th", { scope: "row" }, stroke(style), " ", kind.series.label), ...runs.map(cell));
        };
        const rows = [element("thead", {}, element("tr", {}, this.when, ...runs.map(head))), element("tbody", {}, ...kinds.map(row))];
        this.values.replaceChildren(...(this.lines.length ? [element("table", {}, ...rows)] : [element("p", { className: "hint" }, "No run is chosen, or none has this quantity.")]));
    }

    /** Shows the values at the cursor; at the last time where there is none. */
    read(chart) {
        const times = chart.data[0];
        const index = chart.cursor.idx ?? times.length - 1;
        this.when.textContent = times.length ? `at ${readable(times[index], 6)} s` : "";
        this.lines.forEach((line, at) => {
            // A run that ended before has no value there.
            const ended = times[index] > (line.points.times.at(-1) ?? -Infinity) * (1 + 1e-9);
            const value = chart.data[at + 1][nearest(chart, at + 1, index)];
            this.cells[at].textContent = ended ? "–" : `${readable(value)} ${line.series.unit.symbol}`.trim();
        });
    }

    title() {
        return this.choices[Number(this.choice.value)][0];
    }

    height() {
        return Math.round(Math.min(360, Math.max(220, 0.55 * this.plot.clientWidth)));
    }

    fit() {
        const width = this.plot.clientWidth;
        if (this.uplot && width > 0 && width !== this.uplot.width) this.uplot.setSize({ width, height: this.height() });
    }

    get zoomed() {
        if (!this.uplot) return false;
        const times = this.uplot.data[0];
        const { min, max } = this.uplot.scales.x;
        return min > times[0] || max < times[times.length - 1];
    }

    /** Shows `factor` times as long an interval about the cursor or the middle. */
    zoom(factor) {
        if (!this.uplot) return;
        const { min, max } = this.uplot.scales.x;
        const { left } = this.uplot.cursor;
        const middle = left >= 0 && factor < 1 ? this.uplot.posToVal(left, "x") : 0.5 * (min + max);
        this.zoomTo([middle - 0.5 * factor * (max - min), middle + 0.5 * factor * (max - min)]);
    }

    /** Shows an interval as far as there are data, or all of them. */
    zoomTo(interval) {
        if (!this.uplot) return;
        const times = this.uplot.data[0];
        const [first, last] = [times[0], times[times.length - 1]];
        const [low, high] = interval ?? [first, last];
        if (first < last) this.uplot.setScale("x", { min: Math.max(low, first), max: Math.min(high, last) });
    }

    key(event) {
        if (!this.uplot || event.ctrlKey || event.metaKey || event.altKey) return;
        const width = this.uplot.over.clientWidth;
        const step = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
        if (step) {
            const from = this.uplot.cursor.left >= 0 ? this.uplot.cursor.left : width / 2;
            const left = Math.min(width - 1, Math.max(0, from + (step * width) / 100));
            this.uplot.setCursor({ left, top: this.uplot.over.clientHeight / 2 });
        } else if (event.key === "+" || event.key === "=") this.zoom(0.5);
        else if (event.key === "-") this.zoom(2);
        else if (event.key === "0" || event.key === "Escape") this.zoomTo(null);
        else return;
        event.preventDefault();
    }
}

/** A short piece of a line, as in the chart. */
function stroke({ stroke, dash, alpha }) {
    const make = (name, attributes) => {
        const made = document.createElementNS("http://www.w3.org/2000/svg", name);
        for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
        return made;
    };
    const picture = make("svg", { width: 28, height: 8, "aria-hidden": "true" });
    picture.append(make("line", { x1: 0, y1: 4, x2: 28, y2: 4, stroke, "stroke-width": 2.5, "stroke-dasharray": dash.join(" "), opacity: alpha }));
    return picture;
}

/** The nearest time at which a series has a value: runs and thinned series have different times. */
function nearest(chart, series, index) {
    const values = chart.data[series];
    if (series === 0 || (values[index] !== undefined && values[index] !== null)) return index;
    const times = chart.data[0];
    let [before, behind] = [index, index];
    while (before >= 0 && (values[before] === undefined || values[before] === null)) before--;
    while (behind < values.length && (values[behind] === undefined || values[behind] === null)) behind++;
    if (before < 0) return behind < values.length ? behind : index;
    if (behind >= values.length) return before;
    return times[index] - times[before] <= times[behind] - times[index] ? before : behind;
}

/** Labels of a logarithmic axis: powers of ten. */
function decades(_, splits) {
    return splits.map((split) => {
        const power = split > 0 ? Math.log10(split) : NaN;
        return Math.abs(power - Math.round(power)) < 1e-9 ? readable(split, 3) : "";
    });
}

/** What can be chosen: the groups of which there is any series, then every series alone. */
function choices() {
    const recorded = new Map(report.runs.flatMap((run) => run.series.map((series) => [series.name, series.label])));
    const present = groups.map(([name, series]) => [name, series.filter((series) => recorded.has(series))]);
    return [...present.filter(([, series]) => series.length), ...[...recorded].map(([name, label]) => [label, [name]])];
}

function showCharts() {
    const place = document.getElementById("charts");
    const boxes = report.runs.map(() => element("input", { type: "checkbox", checked: true }));
    const shown = (index) => boxes[index].checked;
    if (place) {
        const legend = document.getElementById("runs-shown");
        const swatches = report.runs.map(() => element("span", { className: "swatch" }));
        legend.append(...report.runs.map((run, index) => element("label", {}, boxes[index], swatches[index], run.label)));
        legend.hidden = report.runs.length < 2;
        const colour = () => swatches.forEach((swatch, index) => (swatch.style.background = scheme().runs[index % 8]));
        colour();
        onScheme(colour);
        boxes.forEach((box) => box.addEventListener("change", () => Chart.all.forEach((chart) => chart.draw())));
        const all = choices();
        for (const chosen of [0, 1, 2]) {
            if (all[chosen]) new Chart(place, all, chosen, shown);
        }
    }
    const residual = document.getElementById("residual-chart");
    if (residual) {
        const recorded = new Set(report.runs.flatMap((run) => run.series.map(({ name }) => name)));
        const names = Object.keys(residuals).filter((name) => recorded.has(name));
        const each = names.map((name) => [residuals[name], [name]]);
        const chart = new Chart(residual, [["Residuals", names], ...each], 0, shown, true);
        chart.magnitude = true;
    }
    const draw = () => Promise.all(Chart.all.map((chart) => chart.draw()));
    onScheme(draw);
    return draw();
}
