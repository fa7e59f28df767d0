// SPDX-License-Identifier: MIT
// Calls whatever the module exports, in any order and with any numbers: node attack.js FOLDER CALLS
// No call may trap, and what is learnt afterwards is what a new module learns. Prints {"calls": ...}.
"use strict";

const fs = require("fs");
const path = require("path");
const vm = require("vm");

const [folder, calls] = process.argv.slice(2);
for (const name of ["wasm.js", "core.js", "maze_lab.js"]) {
    vm.runInThisContext(fs.readFileSync(path.join(folder, name), "utf8"), {filename: name});
}
const {Core, MazeLab} = vm.runInThisContext("({Core, MazeLab})");

const NUMBERS = [0, 1, 2, 7, 255, 1024, 65536, 2 ** 31 - 1, -1, 0.5, -0.5, 1e30, -1e30, NaN, Infinity, -Infinity];
const TEXTS = ["", "\n", "*", ".", ".*", "..\n.*", "..#*\n.#..\n....", "#*", ".x*", "\u0000*", "\u00e9*", ".*\n.",
    "................\n".repeat(8) + "...............*", "*\n*", ".#*"];

// The same numbers on every machine: a linear congruential generator.
let state = 1;
function below(count) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor(state / 2 ** 32 * count);
}

function learnt(core) {
    const lab = new MazeLab(core);
    for (let ticks = 0; lab.view.interactions < 1500; ticks++) {
        lab.tick(100);
    }
    return JSON.stringify([lab.tree, lab.policyC, lab.view.optimal]);
}

function attack(core) {
    const names = Object.keys(core.exports).filter((name) => typeof core.exports[name] === "function");
    const made = {};
    for (let i = 0; i < Number(calls); i++) {
        if (below(4) === 0) {
            core.write(TEXTS[below(TEXTS.length)]);
        }
        const name = names[below(names.length)];
        const numbers = Array.from({length: core.exports[name].length}, () => NUMBERS[below(NUMBERS.length)]);
        if (name.endsWith("_tick") && below(2)) {
            numbers[0] = 50; // often something sensible, so that steps of learning are reached
        }
        try {
            made[name] = (made[name] || 0) + 1;
            core.exports[name](...numbers);
        } catch (error) {
            throw new Error(`call ${i}, ${name}(${numbers}): ${error}`);
        }
    }
    return made;
}

async function main() {
    const core = await Core.load(), expected = learnt(await Core.load());
    const made = attack(core);
    if (learnt(core) !== expected) {
        throw new Error("after these calls another tree is learnt");
    }
    process.stdout.write(JSON.stringify(made));
}

main();
