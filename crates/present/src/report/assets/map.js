
// Maps with a slider over the recorded times.

/** Times closer than this part of the longest are one stop of the slider. */
const sameTime = 1e-3;

/** Status of a place beyond the outline of the pin. */
const absent = 3;

/** Height over width of a strip of the unrolled ring: it is cut into pieces that are not flatter. */
const flattest = () => (document.documentElement.clientWidth < 640 ? 1 / 7 : 1 / 12);

/** What is written below a map, by length. */
const labelsBelow = ["arc length at the mean radius, mm; the disc moves \u2192", "arc length, mm; the disc moves \u2192", "arc length, mm"];

/** One map of one run on a canvas. */
class MapView {
    constructor(run, map, codes, several) {
        Object.assign(this, { run, map, codes });
        this.mesh = run.mesh;
        const what = `${map.title} of ${run.label}`;
        this.canvas = element("canvas", { tabIndex: 0, role: "img", "aria-label": `${what}; arrow keys move the place that is read` });
        this.reading = element("p", { className: "reading" });
        this.reading.setAttribute("aria-live", "polite");
        this.legend = element("div");
        this.heading = element("h3", {}, several ? run.label : map.title);
        this.element = element("div", { className: "panel" }, this.heading, this.canvas, this.reading, this.legend);
        this.image = element("canvas", { width: map.shape[0], height: map.shape[1] });
        this.canvas.addEventListener("pointermove", (event) => this.point(event));
        this.canvas.addEventListener("pointerdown", (event) => this.point(event));
        this.canvas.addEventListener("keydown", (event) => this.key(event));
        this.resize = new ResizeObserver(() => requestAnimationFrame(() => this.draw()));
        this.resize.observe(this.canvas);
    }

    remove() {
        this.resize.disconnect();
    }

    /** Shows the map that was recorded nearest to a time, with these values, SI, as the first and the last colour. */
    show(time, colours) {
        const far = (index) => Math.abs(this.map.times[index] - time);
        this.time = this.map.times.reduce((best, _, index) => (far(index) < far(best) ? index : best), 0);
        this.colours = colours;
        this.paint();
        this.draw();
        this.read();
        this.showLegend();
    }

    /** Cells as pixels: columns to the right, rows outward and so upward. */
    paint() {
        const [columns, rows] = this.map.shape;
        const context = this.image.getContext("2d");
        const pixels = context.createImageData(columns, rows);
        const words = new Uint32Array(pixels.data.buffer);
        const colours = this.colourOfCodes();
        const first = this.time * columns * rows;
        for (let column = 0; column < columns; column++) {
            for (let row = 0; row < rows; row++) {
                words[(rows - 1 - row) * columns + column] = colours[this.codes[first + column * rows + row]];
            }
        }
        context.putImageData(pixels, 0, 0);
    }

    /** The pixel of every code. */
    colourOfCodes() {
        const pixel = (hex) => {
            const [red, green, blue] = [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
            return new Uint32Array(new Uint8Array([red, green, blue, 255]).buffer)[0];
        };
        const { map } = this;
        const empty = pixel(scheme().empty.slice(1));
        const table = new Uint32Array(map.steps + 2).fill(empty);
        if (map.is_status) {
            report.statuses.forEach((status) => (table[status.code] = pixel(status.colour)));
            return table;
        }
        const ramp = report.colours.map(pixel);
        const [low, high] = this.colours;
        for (let code = 0; code <= map.steps; code++) {
            const value = valueOf(map, code);
            const part = high > low ? (value - low) / (high - low) : 0.5;
            const colour = ramp[Math.round(255 * Math.min(1, Math.max(0, part)))];
            table[code] = map.name === "pressure" && value <= 0 ? empty : colour;
        }
        return table;
    }

    /** Width of the map in m, and its height. */
    get size() {
        const columns = this.map.on_disc ? this.mesh.disc_columns : this.mesh.pin_columns;
        return [columns * this.mesh.column_width, this.mesh.rows * this.mesh.row_height];
    }

    /** Lays the map out on the canvas: pieces of the ring below each other, with room for numbers. */
    lay() {
        const width = this.canvas.clientWidth;
        const [left, right, gap] = [44, 10, 20];
        const [length, height] = this.size;
        const inner = Math.max(1, width - left - right);
        const pieces = Math.max(1, Math.min(12, this.map.shape[0], Math.round((flattest() * length) / height)));
        // The pin is no wider than a screen is high; what is very flat or very high is stretched to be seen at all.
        const scale = Math.min(inner / (length / pieces), 420 / height);
        const across = Math.max(40, Math.min(inner, (length / pieces) * scale));
        const high = Math.min(420, Math.max(24, height * scale));
        this.layout = { width, left, inner: across, pieces, high, gap, length, height, total: pieces * (high + gap) + 18 };
    }

    draw() {
        if (this.canvas.clientWidth === 0 || this.time === undefined) return;
        this.lay();
        const { width, left, inner, pieces, high, gap, length, height, total } = this.layout;
        const density = window.devicePixelRatio || 1;
        const [across, down] = [Math.round(width * density), Math.round(total * density)];
        if (this.canvas.width !== across || this.canvas.height !== down) {
            Object.assign(this.canvas, { width: across, height: down });
            this.canvas.style.height = `${total}px`;
        }
        const context = this.canvas.getContext("2d");
        context.setTransform(density, 0, 0, density, 0, 0);
        context.clearRect(0, 0, width, total);
        const [columns, rows] = this.map.shape;
        const part = columns / pieces;
        context.imageSmoothingEnabled = !this.map.is_status && part > inner * density;
        context.font = "11px system-ui, sans-serif";
        context.fillStyle = scheme().ink;
        const millimetres = (metres) => readable(metres * 1e3, 4);
        for (let piece = 0; piece < pieces; piece++) {
            const top = 6 + piece * (high + gap);
            context.drawImage(this.image, piece * part, 0, part, rows, left, top, inner, high);
            context.textBaseline = "top";
            context.textAlign = "left";
            context.fillText(millimetres((length * piece) / pieces), left, top + high + 3);
            context.textAlign = "right";
            context.fillText(millimetres((length * (piece + 1)) / pieces), left + inner, top + high + 3);
            context.textBaseline = "middle";
            context.fillText(millimetres(this.mesh.inner_radius + height), left - 4, top + 6);
            context.fillText(millimetres(this.mesh.inner_radius), left - 4, top + high - 6);
        }
        context.textAlign = "center";
        context.textBaseline = "top";
        const middle = left + inner / 2;
        // The numbers of both ends stand beside it.
        const fits = (label) => context.measureText(label).width < inner - 100;
        const label = labelsBelow.find(fits) ?? labelsBelow.at(-1);
        context.fillText(label, middle, 6 + (pieces - 1) * (high + gap) + high + 3);
        context.save();
        context.translate(2, 6 + high / 2);
        context.rotate(-Math.PI / 2);
        context.textBaseline = "top";
        if (high > 90) context.fillText("radius, mm", 0, 0);
        context.restore();
        if (high <= 90) {
            context.textAlign = "left";
            context.fillText("left: radius, mm", left, total - 13);
        }
        this.mark(context);
    }

    /** A cross at the place that is read. */
    mark(context) {
        if (!this.place) return;
        const { left, inner, pieces, high, gap } = this.layout;
        const [columns, rows] = this.map.shape;
        const part = columns / pieces;
        const piece = Math.min(pieces - 1, Math.floor(this.place[0] / part));
        const x = left + ((this.place[0] + 0.5 - piece * part) / part) * inner;
        const y = 6 + piece * (high + gap) + ((rows - this.place[1] - 0.5) / rows) * high;
        for (const [colour, width] of [["#000000", 3], ["#ffffff", 1]]) {
            context.strokeStyle = colour;
            context.lineWidth = width;
            context.beginPath();
            context.arc(x, y, 5, 0, 2 * Math.PI);
            context.stroke();
        }
    }

    point(event) {
        const { left, inner, pieces, high, gap } = this.layout;
        const box = this.canvas.getBoundingClientRect();
        const [x, y] = [event.clientX - box.left - left, event.clientY - box.top - 6];
        const piece = Math.floor(y / (high + gap));
        const down = y - piece * (high + gap);
        if (x < 0 || x >= inner || piece < 0 || piece >= pieces || down < 0 || down >= high) return;
        const [columns, rows] = this.map.shape;
        const column = Math.floor(((piece + x / inner) * columns) / pieces);
        this.placeAt(column, Math.floor(((high - down) / high) * rows));
    }

    key(event) {
        const [column, row] = this.place ?? this.map.shape.map((count) => Math.floor(count / 2));
        const far = event.shiftKey ? 10 : 1;
        const moves = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, far], ArrowDown: [0, -far] };
        const move = moves[event.key];
        if (!move || event.ctrlKey || event.metaKey || event.altKey) return;
        this.placeAt(column + (this.place ? move[0] : 0), row + (this.place ? move[1] : 0));
        event.preventDefault();
    }

    placeAt(column, row) {
        const within = (index, count) => Math.min(count - 1, Math.max(0, index));
        this.place = [within(column, this.map.shape[0]), within(row, this.map.shape[1])];
        this.draw();
        this.read();
    }

    /** Says value and place. */
    read() {
        const { map, mesh } = this;
        const when = `at ${readable(map.times[this.time], 6)} s`;
        if (!this.place) {
            this.reading.textContent = `${when}; point at the map to read values`;
            return;
        }
        const [column, row] = this.place;
        const code = this.codes[(this.time * map.shape[0] + column) * map.shape[1] + row];
        const status = report.statuses.find((status) => status.code === code);
        const value = map.is_status ? (status?.name ?? (code === absent ? "no cell" : `status ${code}`)) : this.value(code);
        const middle = (index, direction, cells) => 0.5 * (index * map.block[direction] + Math.min(cells, (index + 1) * map.block[direction]));
        const cells = map.on_disc ? mesh.disc_columns : mesh.pin_columns;
        const along = middle(column, 0, cells) * mesh.column_width;
        const radius = mesh.inner_radius + middle(row, 1, mesh.rows) * mesh.row_height;
        const cell = map.block[0] * map.block[1] > 1 ? "" : `, column ${column}, row ${row}`;
        this.reading.textContent = `${value} ${when}, arc length ${readable(along * 1e3, 5)} mm, radius ${readable(radius * 1e3, 5)} mm${cell}`;
    }

    /** A value in words, also as told from the mean where there is one. */
    value(code) {
        const { map } = this;
        const [value, reference] = [valueOf(map, code), map.reference[this.time]];
        if (value === null || reference === 0) return withUnit(value, map.unit);
        return `${withUnit(reference + value, map.unit, 6)} (mean ${value < 0 ? "" : "+"}${withUnit(value, map.unit)})`;
    }

    showLegend() {
        const swatch = (colour) => {
            const made = element("span", { className: "swatch" });
            made.style.background = colour;
            return made;
        };
        if (this.map.is_status) {
            const names = report.statuses.filter((status) => !(this.map.on_disc && status.code === 0));
            this.legend.className = "key";
            this.legend.replaceChildren(...names.map((status) => element("span", {}, swatch(`#${status.colour}`), `${status.name}: ${this.share(status.code)}`)));
            return;
        }
        const bar = element("div");
        bar.style.background = `linear-gradient(to right, ${report.colours.filter((_, index) => index % 15 === 0).map((colour) => `#${colour}`).join(", ")})`;
        const [low, high] = this.colours.map((value) => withUnit(value, this.map.unit));
        this.legend.className = "colour-bar";
        this.legend.replaceChildren(element("span", {}, low), bar, element("span", {}, high));
        const mean = this.map.reference[this.time];
        if (mean !== 0) this.legend.append(element("span", { className: "wide" }, `about the mean, ${withUnit(mean, this.map.unit, 6)}`));
        if (this.map.name === "pressure") this.legend.append(element("span", {}, swatch(scheme().empty), " no contact"));
    }

    /** Part of the cells with a status. */
    share(code) {
        const cells = this.map.shape[0] * this.map.shape[1];
        let [count, all] = [0, 0];
        for (let cell = 0; cell < cells; cell++) {
            const found = this.codes[this.time * cells + cell];
            if (found === code) count++;
            if (found !== absent) all++;
        }
        return `${readable((100 * count) / all, 3)} % of the cells`;
    }
}

/** Stops of the slider: the times of all runs, those that hardly differ once. */
function stops(maps) {
    const times = maps.flatMap((map) => map.times).sort((one, other) => one - other);
    const close = sameTime * (times[times.length - 1] ?? 0);
    return times.filter((time, index) => index === 0 || time - times[index - 1] > close);
}

async function showMaps() {
    const place = document.getElementById("map-views");
    if (!place) return;
    const controls = document.getElementById("map-controls");
    const names = new Map(report.runs.flatMap((run) => run.maps.map((map) => [map.name, map.title])));
    const choice = element("select", { "aria-label": "Map" }, ...[...names].map(([name, title]) => new Option(title, name)));
    const slider = element("input", { type: "range", min: 0, step: 1, "aria-label": "Time of the maps" });
    const output = element("output");
    const play = element("button", { type: "button" }, "Play");
    const common = element("input", { type: "checkbox", checked: true });
    const commonLabel = element("label", {}, common, "same colours for all runs");
    controls.append(element("label", {}, "Map", choice), element("label", { className: "time" }, "Time", slider, output), play, commonLabel);
    let views = [];
    let times = [];

    const show = () => {
        const time = times[Number(slider.value)];
        output.textContent = `${readable(time, 6)} s`;
        slider.setAttribute("aria-valuetext", output.textContent);
        const ranges = views.map((view) => view.map.colours);
        const all = [Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))];
        for (const view of views) view.show(time, common.checked ? all : view.map.colours);
    };
    const choose = async () => {
        const chosen = report.runs.flatMap((run) => run.maps.filter((map) => map.name === choice.value).map((map) => ({ run, map })));
        const codes = await Promise.all(chosen.map(({ run, map }) => readCodes(run, map)));
        if (chosen[0]?.map.name !== choice.value) return;
        views.forEach((view) => view.remove());
        const places = views.map((view) => view.place);
        const wasOnDisc = views[0]?.map.on_disc;
        views = chosen.map(({ run, map }, index) => new MapView(run, map, codes[index], chosen.length > 1));
        if (wasOnDisc === views[0].map.on_disc) views.forEach((view, index) => (view.place = places[index]));
        const before = times[Number(slider.value)];
        times = stops(chosen.map(({ map }) => map));
        slider.max = times.length - 1;
        const far = (index) => Math.abs(times[index] - before);
        slider.value = before === undefined ? times.length - 1 : times.reduce((best, _, index) => (far(index) < far(best) ? index : best), 0);
        slider.disabled = play.disabled = times.length < 2;
        commonLabel.hidden = chosen.length < 2 || views[0].map.is_status;
        place.className = views[0].map.on_disc ? "" : "side-by-side";
        place.replaceChildren(...views.map((view) => view.element));
        show();
    };
    let playing;
    const stop = () => {
        clearInterval(playing);
        playing = undefined;
        play.textContent = "Play";
    };
    play.addEventListener("click", () => {
        if (playing) return stop();
        play.textContent = "Stop";
        if (Number(slider.value) === times.length - 1) slider.value = 0;
        show();
        playing = setInterval(() => {
            slider.value = Number(slider.value) + 1;
            show();
            if (Number(slider.value) === times.length - 1) stop();
        }, 700);
    });
    choice.addEventListener("change", choose);
    slider.addEventListener("input", show);
    common.addEventListener("change", show);
    onScheme(show);
    await choose();
}
