// SPDX-License-Identifier: GPL-3.0-or-later
// A job type for Flamenco (3.3 or newer): scanned drawings to one Grease Pencil animation.
// Put this file into the folder `scripts` beside flamenco-manager, and restart the Manager.

const JOB_TYPE = {
    label: "Involute: Trace Drawings",
    settings: [
        { key: "images", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Folder of the scanned drawings, numbered in their names; or one TIFF or movie" },
        { key: "output", type: "string", subtype: "file_path", required: true, visible: "submission",
          description: "The .blend file that the job makes, or a folder for one drawing per file" },
        { key: "frames", type: "string", required: true,
          eval: "(lambda found: f'{min(found)}-{max(found)}' if found else '')([int(digits[-1])"
              + " for digits in map(__import__('re').compile('[0-9]+').findall, [file.stem for file in"
              + " (abspath(settings.images).glob('[!.]*.*') if settings.images else [])]) if digits])",
          evalInfo: { showLinkButton: true, description: "From the first to the last number in the folder" },
          description: "Numbers of the drawings, as in their names. Examples: '47', '1-30', '3, 5-10'" },
        { key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
          description: "Number of drawings that one task traces" },
        { key: "start", type: "string", default: "", label: "First Frame",
          description: "Frame of the first drawing; empty: its own number" },
        { key: "step", type: "int32", default: 1, propargs: { min: 1 },
          description: "Frames from one number to the next; 2 puts drawings on twos" },
        { key: "align", type: "bool", default: false,
          description: "Bring all pages to where the peg holes or registration marks of the first one lie" },
        { key: "polarity", type: "string", choices: ["auto", "dark", "light"], default: "auto", label: "Lines",
          description: "Which side of the picture is ink" },
        { key: "curve", type: "string", choices: ["polyline", "bezier"], default: "polyline", label: "Curves",
          description: "What the strokes are made of" },
        { key: "smoothing", type: "float", default: 0.3, propargs: { min: 0, max: 1 },
          description: "How much the wobble of hand and paper is smoothed" },
        { key: "tolerance", type: "float", default: 0.15, propargs: { min: 0, max: 50 },
          description: "How far a stroke may lie off the line to save points, in pixels" },
        { key: "options", type: "string", default: "", label: "More Options",
          description: "Further options of 'involute trace', such as --corners 0 --ignore-inks blue" },
        { key: "involute", type: "string", default: "{blender} -b --command involute", visible: "submission",
          label: "Call", description: "How the workers call Involute" },

        // Found out when the job is submitted: Blender's paths that begin with // are made whole.
        { key: "images_path", type: "string", visible: "hidden",
          eval: "str(abspath(settings.images)) if settings.images else ''" },
        { key: "output_path", type: "string", visible: "web",
          eval: "str(abspath(settings.output)) if settings.output else ''" },
    ],
};

const EVERYTHING = 2147483647; // drawings in one chunk
const LONGEST = 4096; // characters of a setting

function compileJob(job) {
    const settings = job.settings;
    const images = checkedPath("Images", settings.images_path || settings.images);
    const output = checkedPath("Output", settings.output_path || settings.output);

    const call = words("Call", settings.involute || "{blender} -b --command involute", true);
    if (call.length === 0) {
        throw "Call: say how the workers call Involute.";
    }
    const trace = call.slice(1).concat(["trace", images, "--sequence", "--parts", `${output}.parts`, "--skip-failed"],
        traceOptions(settings));
    const chunks = frameChunker(checkedFrames(settings.frames), checkedNumber("Chunk Size", settings.chunk_size, 10));
    const all = frameChunker(checkedFrames(settings.frames), EVERYTHING)[0];

    const tracing = chunks.map(chunk =>
        task(`trace-${chunk}`, call[0], trace.concat(["--frames", chunk, "--jobs", "0"])));
    const joining = task("join", call[0], trace.concat(["--frames", all, "-o", output,
        "--report", `${output.replace(/\.blend$/i, "")}-report.json`, "--overwrite"]));
    for (const one of tracing) {
        joining.addDependency(one);
        job.addTask(one);
    }
    job.addTask(joining);
}

function task(name, exe, args) {
    const made = author.Task(name, "blender");
    made.addCommand(author.Command("exec", { exe: exe, args: args }));
    return made;
}

// The options of `involute trace`, those with the usual value left out.
function traceOptions(settings) {
    let options = [];
    for (const setting of JOB_TYPE.settings) {
        const value = rounded(settings[setting.key]);
        const isOption = ["start", "step", "align", "polarity", "curve", "smoothing", "tolerance"].includes(setting.key);
        if (!isOption || value === undefined || value === null || value === "" || value === setting.default) {
            continue;
        }
        options.push(`--${setting.key}`);
        if (setting.type !== "bool") {
            options.push(checkedText(setting.label || setting.key, `${value}`));
        }
    }
    return options.concat(words("More Options", settings.options || "", false));
}

// Blender keeps 0.3 as 0.30000001192092896.
function rounded(value) {
    return typeof value === "number" ? Number(value.toPrecision(6)) : value;
}

function words(label, text, mayHaveVariables) {
    const split = shellSplit(mayHaveVariables ? checkedCharacters(label, text) : checkedText(label, text));
    return Array.from(split || []);
}

// A path that means the same to every worker: a whole one, or one that begins with a variable.
function checkedPath(label, path) {
    const text = checkedCharacters(label, `${path || ""}`);
    const variable = text.match(/^\{[A-Za-z0-9_]+\}/);
    const rest = variable ? text.slice(variable[0].length) : text;
    checkedText(label, rest);
    if (!variable && !/^(\/(?!\/)|[A-Za-z]:[\\/]|\\\\)/.test(text)) {
        throw `${label}: '${text}' is no whole path; choose a folder that all workers reach.`;
    }
    return text;
}

// Text that no worker reads as something else: {name} would be a variable of the farm.
function checkedText(label, text) {
    if (/[{}]/.test(checkedCharacters(label, text))) {
        throw `${label}: '${text}' would be a variable to Flamenco; choose another name.`;
    }
    return text;
}

function checkedCharacters(label, text) {
    if (/[\u0000-\u001f\u007f]/.test(text) || text.length > LONGEST) {
        throw `${label}: this is no name for a farm; choose another one.`;
    }
    return text;
}

function checkedFrames(frames) {
    const text = `${frames || ""}`.trim();
    if (!/^\d{1,7}(\s*(-|\.\.)\s*\d{1,7})?(\s*,\s*\d{1,7}(\s*(-|\.\.)\s*\d{1,7})?)*$/.test(text)) {
        throw `Frames: can't read '${text.slice(0, 40)}'; write for example 1-30 or 3, 5-10.`;
    }
    return text;
}

function checkedNumber(label, value, usual) {
    const number = value === undefined || value === null ? usual : Number(value);
    if (!Number.isInteger(number) || number < 1) {
        throw `${label}: '${value}' is no number from 1 on.`;
    }
    return number;
}
