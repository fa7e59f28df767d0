// SPDX-License-Identifier: MIT
// A maze and the agent that learns it: what maze.c exports, as JavaScript sees it.
"use strict";

const ACTIONS = ["up", "right", "down", "left"];
const NO_CLASS = 65535; // a wall or an exit
const MIXED = 65534; // percepts of the cell belong to several classes

const RETURNS_KEPT = 400;

const VIEW = ["width", "height", "freeCells", "bits", "xBits", "yBits", "interactions", "schedule", "step", "classes",
    "depth", "refused", "cell", "learning", "optimal", "bytes", "episodes", "~episodeReturn", "~mean", "~meanOptimal"];

// Rooms of 9 x 9 cells with doors of two.
function nineRooms() {
    const wall = (along, across) => along % 10 === 9 && along < 29 && across % 10 !== 4 && across % 10 !== 5;
    return Array.from({length: 30}, (_, y) => Array.from({length: 30}, (__, x) =>
        x === 29 && y === 0 ? "*" : wall(x, y) || wall(y, x) ? "#" : ".").join("")).join("\n");
}

const MAZES = {
    "Sutton's, 9 by 6": ".......#*\n..#....#.\n..#....#.\n..#......\n.....#...\n.........",
    "Two rooms, 11 by 7": "...........\n.....#.....\n.....#.....\n...........\n.....#.....\n.....#.....\n.....#....*",
    "Spiral, 9 by 9": ".........\n.#######.\n.#.....#.\n.#.###.#.\n.#.#*#.#.\n.#.#.#.#.\n.#.#...#.\n.#.#####.\n.#.......",
    "Empty, 8 by 8": ".......*\n........\n........\n........\n........\n........\n........\n........",
    "Nine rooms, 30 by 30": nineRooms(),
};

const DEFAULTS = {returns: false, distractors: 11, slip: 0, epsilon: -1, seed: 1};

class MazeLab {
    constructor(core) {
        this.core = core;
        this.options = {...DEFAULTS};
        this.rows = MAZES["Sutton's, 9 by 6"].split("\n");
        this.reset();
    }

    // Learning starts anew. Returns whether the maze and the options are possible; `fault` says why not.
    reset() {
        const {returns, distractors, slip, epsilon, seed} = this.options;
        this.core.write(this.rows.join("\n"));
        const status = this.core.exports.maze_new(returns ? 1 : 0, distractors, slip, epsilon, seed);
        this.fault = status === 0 ? "" : this.describe(status);
        this.history = [];
        this.returns = [];
        return !this.fault;
    }

    describe(status) {
        if (status !== 1) {
            return status === 2 ? "These options are not possible." : "There is no memory for this maze.";
        }
        const line = this.core.exports.maze_fault();
        const what = this.core.text();
        return line ? `Row ${line}, column ${this.core.exports.maze_fault_column()}: ${what}.` : `The maze: ${what}.`;
    }

    // Some interactions, or a slice of learning. Returns TICK.
    tick(count) {
        const before = this.view.interactions;
        const result = this.core.exports.maze_tick(count);
        const view = this.view;
        if (view.interactions > before && result === TICK.episodeOver) {
            this.returns.push([view.interactions, view.episodeReturn]);
            if (this.returns.length > RETURNS_KEPT) {
                this.returns.splice(0, RETURNS_KEPT / 2);
            }
        }
        if (result === TICK.learnt) {
            const splits = view.classes - (this.history.length ? this.history.at(-1).classes : 1);
            this.history.push({step: view.step - 1, interactions: view.interactions, splits, classes: view.classes,
                optimal_cells: view.optimal, mean: view.mean});
        }
        return result;
    }

    get view() {
        return this.core.struct(this.core.exports.maze_view(), VIEW);
    }

    // The class of each cell, in rows from the top, and its action.
    get classes() {
        const count = this.rows.length * this.rows[0].length;
        return new Uint16Array(this.core.exports.memory.buffer, this.core.exports.maze_classes(), count).slice();
    }

    get actions() {
        return this.core.bytes(this.core.exports.maze_actions(), this.rows.length * this.rows[0].length).slice();
    }

    // The bits of a percept of a cell, as an array of 0 and 1.
    percept(cell, draw) {
        const {bits} = this.view;
        const bytes = this.core.bytes(this.core.exports.maze_percept(cell, draw), Math.ceil(bits / 8));
        return Array.from({length: bits}, (_, i) => bytes[i >> 3] >> (i & 7) & 1);
    }

    written(name) {
        return this.core.exports[name]() ? this.core.text() : "";
    }

    get tree() {
        return JSON.parse(this.written("maze_tree"));
    }

    // The smallest tree that acts as the agent does, or null if there was no memory to find it.
    get policy() {
        const text = this.written("maze_policy");
        return text ? JSON.parse(text) : null;
    }

    get policyC() {
        return this.written("maze_policy_c");
    }

    // What a bit of a percept says: {kind: "x", worth: 8}, likewise "y"; or {kind: "noise"}.
    meaning(bit) {
        const {xBits, yBits, bits} = this.view;
        if (bit < xBits) {
            return {kind: "x", worth: 2 ** bit};
        }
        return bit < bits - yBits ? {kind: "noise", worth: 0} : {kind: "y", worth: 2 ** (bit - bits + yBits)};
    }

    // The run, with the members that run_gridworld's reports have.
    report() {
        const view = this.view, {width, height} = view, rows = (values, of) => Array.from({length: height}, (_, y) =>
            Array.from({length: width}, (__, x) => of(values[y * width + x], this.rows[y][x])));
        const range = (first, count) => Array.from({length: count}, (_, i) => first + i);
        return {
            version: 1, kind: "playground", program: `rlvc ${this.core.version}`,
            options: {...this.options, returns: undefined, criterion: this.options.returns ? "returns" : "residual"},
            percept: {bits: view.bits, x_bits: range(0, view.xBits),
                distractor_bits: range(view.xBits, view.bits - view.xBits - view.yBits),
                y_bits: range(view.bits - view.yBits, view.yBits)},
            seed: this.options.seed, cells: view.freeCells, optimal_cells: view.optimal,
            interactions: view.interactions, classes: view.classes, depth: view.depth, memory_bytes: view.bytes,
            maze: this.rows,
            cell_classes: rows(this.classes, (value) => value >= MIXED ? null : value),
            cell_actions: rows(this.actions, (value, sign) => sign === "." ? ACTIONS[value] : null),
            history: this.history, tree: this.tree, policy: this.policy,
        };
    }
}
