// SPDX-License-Identifier: MIT
// Learns a maze as the page does, but without a browser: node learn.js FOLDER OPTIONS [MAZE]
// FOLDER is a built playground. Prints {"tree": ..., "c": ..., "interactions": ...}.
"use strict";

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, options, maze] = process.argv.slice(2);
for (const name of ["wasm.js", "core.js", "maze_lab.js"]) {
    vm.runInThisContext(fs.readFileSync(path.join(folder, name), "utf8"), {filename: name});
}

async function learn() {
    const {Core, MazeLab} = vm.runInThisContext("({Core, MazeLab})");
    const lab = new MazeLab(await Core.load());
    Object.assign(lab.options, JSON.parse(options));
    if (maze) {
        lab.rows = fs.readFileSync(maze, "utf8").trim().split("\n");
    }
    if (!lab.reset()) {
        throw new Error(lab.fault);
    }
    while (lab.view.interactions < lab.view.schedule || lab.view.learning) {
        lab.tick(1000);
    }
    return {tree: lab.tree, interactions: lab.view.interactions, c: lab.options.returns ? "" : lab.policyC};
}

learn().then((result) => process.stdout.write(JSON.stringify(result)));
