// What Flamenco's documentation says that a job compiler script finds: the globals `author`,
// `frameChunker`, `shellSplit`, `print`, `alert`, and a job with settings and addTask().
const author = {
    Task: (name, type) => {
        if (!name.trim() || !type.trim()) throw "author.Task(name, type): both are required";
        return { name: name.trim(), type: type.trim(), commands: [], dependencies: [],
                 addCommand(command) { this.commands.push(command); },
                 addDependency(task) { this.dependencies.push(task.name); } };
    },
    Command: (name, parameters) => ({ name, parameters }),
};

function print() {}
function alert() {}

// "1..10, 12" in chunks of at most so many frames: "1-5", "6-10", "12".
function frameChunker(range, size) {
    if (!(size >= 1)) throw "invalid chunk size";
    const frames = new Set();
    for (const part of range.replaceAll("..", "-").split(",")) {
        const [first, last] = part.split("-").map(Number);
        for (let n = first; n <= (last === undefined ? first : last); n++) frames.add(n);
    }
    const sorted = [...frames].sort((a, b) => a - b);
    if (!sorted.length) throw "empty range";
    const chunks = [];
    for (let i = 0; i < sorted.length; i += size) chunks.push(merged(sorted.slice(i, i + size)));
    return chunks;
}

function merged(frames) {
    const spans = [];
    for (const n of frames) {
        if (spans.length && n === spans[spans.length - 1][1] + 1) spans[spans.length - 1][1] = n;
        else spans.push([n, n]);
    }
    return spans.map(([a, b]) => a === b ? `${a}` : b === a + 1 ? `${a},${b}` : `${a}-${b}`).join(",");
}

// Words as a POSIX shell splits them, with nothing expanded.
function shellSplit(text) {
    const words = [];
    let word = null, quote = "";
    for (let i = 0; i < text.length; i++) {
        const sign = text[i];
        if (quote === "'") { if (sign === "'") quote = ""; else word += sign; }
        else if (sign === "\\") { word = (word ?? "") + (text[++i] ?? ""); }
        else if (quote === '"') { if (sign === '"') quote = ""; else word += sign; }
        else if (sign === "'" || sign === '"') { quote = sign; word = word ?? ""; }
        else if (/\s/.test(sign)) { if (word !== null) words.push(word); word = null; }
        else word = (word ?? "") + sign;
    }
    if (quote) throw "EOF found when expecting closing quote";
    if (word !== null) words.push(word);
    return words;
}

// JSON of the tasks, or of what was thrown.
function compiled(submitted) {
    const tasks = [];
    const job = { name: "shot", settings: submitted, addTask: task => tasks.push(task) };
    try {
        compileJob(job);
    } catch (error) {
        return JSON.stringify({ error: `${error}` });
    }
    return JSON.stringify({ tasks });
}
