
// What is packed in the JSON document of a page of runs.

/** Bytes behind a packed text: base64 of zlib. */
async function inflate(text) {
    const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Numbers of `size` bytes each, of which those of equal weight stand together, the lowest first. */
async function unpack(text, size, Kind) {
    const planes = await inflate(text);
    const count = planes.length / size;
    const bytes = new Uint8Array(planes.length);
    for (let plane = 0; plane < size; plane++) {
        for (let index = 0; index < count; index++) {
            bytes[index * size + plane] = planes[plane * count + index];
        }
    }
    return new Kind(bytes.buffer);
}

/** A series of a run: {times, values}, in s and SI units. */
function readSeries(run, series) {
    return (series.read ??= decodeSeries(run, series));
}

async function decodeSeries(run, series) {
    run.allTimes ??= unpack(run.time, 8, Float64Array);
    const [times, steps, values] = await Promise.all([
        run.allTimes,
        unpack(series.at, 4, Uint32Array),
        unpack(series.values, 4, Float32Array),
    ]);
    let at = 0;
    return { times: Array.from(steps, (step) => times[(at += step)]), values: Array.from(values) };
}

/** Codes of a map of a run at all its times, one after the other. */
function readCodes(run, map) {
    return (map.read ??= decodeCodes(run, map));
}

async function decodeCodes(run, map) {
    const wide = map.steps > 255;
    const codes = await (wide ? unpack(map.codes, 2, Uint16Array) : inflate(map.codes));
    const before = map.told_from && (await readCodes(run, run.maps.find(({ name }) => name === map.told_from)));
    const cells = map.shape[0] * map.shape[1];
    for (let index = 0; index < codes.length; index++) {
        // Both kinds of array wrap round as the differences do.
        if (index >= cells) codes[index] += codes[index - cells];
        else if (before) codes[index] += before[index];
    }
    return codes;
}

/** The value behind a code less the reference of its time, SI; nothing where there was no number. */
function valueOf(map, code) {
    return code > map.steps ? null : map.range[0] + (code / map.steps) * (map.range[1] - map.range[0]);
}

/** A value, SI, in a unit; only degrees Celsius have an offset. */
function inUnit(value, unit) {
    return value * unit.scale + (unit.offset ?? 0);
}

/** A number with its unit. */
function withUnit(value, unit, digits) {
    return value === null ? "no number" : `${readable(inUnit(value, unit), digits)} ${unit.symbol}`.trim();
}
