// SPDX-License-Identifier: MIT
// The first tab: draw a maze, and watch it being learnt.
"use strict";

const BATCH = 500; // interactions between two looks at the clock
const REFRESH_MS = 150; // between two drawings of the tree, while learning steps follow each other

const $ = (id) => document.getElementById(id);

// Labels of a maze's tree: what a bit says, in few signs and in a sentence.
function bitLabel(lab, node) {
    const bit = Number(node.test.slice(4)), {kind, worth} = lab.meaning(bit);
    const says = kind === "noise" ? "a random bit" : `the part of ${kind} that is worth ${worth}`;
    return {text: node.test, short: String(bit), kind, long: `Is ${node.test} set? It is ${says}.`};
}

function classLabel(node) {
    return {text: `${ARROWS[node.action]} ${node.class}`, tint: tintOf(node.class),
        long: `class ${node.class}: go ${ACTIONS[node.action]}`};
}

// Which cells come to a node, and by which side they leave it: 0, 1, or nothing.
function sidesOf(tree, node, classes) {
    const nodes = new Map(tree.nodes.map((each) => [each.node, each]));
    const below = (number) => {
        const each = nodes.get(number);
        return "test" in each ? [...below(each.absent), ...below(each.present)] : [each.class];
    };
    const sides = new Map();
    if ("test" in node) {
        below(node.absent).forEach((classId) => sides.set(classId, 0));
        below(node.present).forEach((classId) => sides.set(classId, 1));
    } else {
        sides.set(node.class, 1);
    }
    return Array.from(classes, (classId) => sides.get(classId));
}

function probability(logP) {
    const p = Math.exp(logP);
    if (p >= 0.001) {
        return p.toFixed(3);
    }
    const exponent = Math.floor(logP / Math.LN10), raised = [...String(-exponent)].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]).join("");
    return `${Math.exp(logP - exponent * Math.LN10).toFixed(1)} · 10⁻${raised}`;
}

class MazeTab {
    constructor(lab) {
        this.lab = lab;
        this.view = new MazeView($("maze"), {edit: (cell, sign) => this.edit(cell, sign)});
        this.tree = new TreeView($("tree"), {select: (node) => this.select(node), label: (node) => bitLabel(lab, node),
            leaf: classLabel});
        this.charts = {
            value: new Chart($("chart-value"), {title: "Value of the policy", digits: 1}),
            returns: new Chart($("chart-returns"), {title: "Return while exploring", colour: COLOUR.orange}),
            classes: new Chart($("chart-classes"), {title: "Classes", colour: "#6a4c93", steps: true}),
        };
        this.runner = new Runner({speeds: [4, 40, 400, 4000, 1e9], work: (due, until) => this.work(due, until),
            drawn: () => this.drawn()});
        this.finished = false;
        this.bind();
        this.reset();
    }

    bind() {
        $("run").addEventListener("click", () => this.toggle());
        $("step").addEventListener("click", () => this.step());
        $("faster").addEventListener("click", () => this.setSpeed(Math.min(this.runner.speed + 1, 4)));
        $("speed").addEventListener("input", () => this.setSpeed(Number($("speed").value)));
        $("reset").addEventListener("click", () => this.reset());
        for (const id of ["criterion", "distractors", "slip", "epsilon", "seed"]) {
            $(id).addEventListener("change", () => this.readOptions());
        }
        $("slip").addEventListener("input", () => this.showSliders());
        $("epsilon").addEventListener("input", () => this.showSliders());
        $("preset").append(...Object.keys(MAZES).map((name) => new Option(name)));
        $("preset").addEventListener("change", () => this.take(MAZES[$("preset").value]));
        $("load").addEventListener("change", async () => {
            if ($("load").files.length) {
                this.take((await $("load").files[0].text()).replace(/\r/g, "").replace(/\n+$/, ""));
                $("load").value = "";
            }
        });
        $("save").addEventListener("click", () => this.save());
        $("copy").addEventListener("click", () => this.copy());
        document.querySelectorAll("input[name=tool]").forEach((radio) =>
            radio.addEventListener("change", () => { this.view.tool = radio.value; }));
        $("widen").addEventListener("click", () => this.resize(1));
        $("narrow").addEventListener("click", () => this.resize(-1));
    }

    // ---------------------------------------------------------------- the maze and the options

    take(text) {
        const rows = text.split("\n"), before = this.lab.rows;
        this.lab.rows = rows;
        if (!rows.every((row) => row.length === rows[0].length && /^[#.*]+$/.test(row))) {
            this.lab.reset();
            this.say(this.lab.fault, true);
            this.lab.rows = before;
            this.lab.reset();
            return;
        }
        this.reset();
    }

    edit(cell, sign) {
        const width = this.lab.rows[0].length, y = Math.floor(cell / width), x = cell % width, row = this.lab.rows[y];
        this.lab.rows[y] = row.slice(0, x) + sign + row.slice(x + 1);
        this.reset();
    }

    resize(by) {
        const width = this.lab.rows[0].length + by, height = this.lab.rows.length + by;
        if (Math.min(width, height) < 2 || Math.max(width, height) > 40) {
            return;
        }
        const at = (x, y) => this.lab.rows[y]?.[x] ?? ".";
        this.lab.rows = Array.from({length: height}, (_, y) => Array.from({length: width}, (__, x) => at(x, y)).join(""));
        if (!this.lab.rows.some((row) => row.includes("*"))) {
            this.lab.rows[0] = `${this.lab.rows[0].slice(0, -1)}*`;
        }
        this.reset();
    }

    readOptions() {
        Object.assign(this.lab.options, {returns: $("criterion").value === "returns", slip: Number($("slip").value),
            distractors: Math.min(Math.max(Math.round(Number($("distractors").value)) || 0, 0), 900),
            epsilon: Number($("epsilon").value), seed: Number($("seed").value) >>> 0});
        $("distractors").value = this.lab.options.distractors;
        this.showSliders();
        this.reset();
    }

    showSliders() {
        $("slip-now").textContent = Number($("slip").value).toFixed(2);
        $("epsilon-now").textContent = Number($("epsilon").value) < 0 ? "default" : Number($("epsilon").value).toFixed(2);
    }

    // ---------------------------------------------------------------- running

    reset() {
        this.stop();
        this.finished = false;
        this.tree.root = 0;
        this.tree.chosen = -1;
        const possible = this.lab.reset();
        for (const id of ["run", "step", "save", "copy"]) {
            $(id).disabled = !possible;
        }
        this.say(this.lab.fault || "Draw walls with mouse or finger, then press Run.", Boolean(this.lab.fault));
        this.refresh(possible);
        this.onReset?.();
    }

    toggle() {
        if (this.runner.running) {
            this.stop();
            return;
        }
        $("run").textContent = "Pause";
        this.say("");
        this.runner.start();
    }

    stop() {
        this.runner.stop();
        $("run").textContent = "Run";
    }

    setSpeed(speed) {
        this.runner.speed = speed;
        $("speed").value = speed;
        $("speed-now").textContent = speed === 4 ? "as fast as it can" : `${this.runner.perSecond} a second`;
    }

    // Goes on to the end of the next learning step.
    step() {
        this.stop();
        this.say("");
        while (this.lab.tick(BATCH) !== TICK.learnt) {
            continue;
        }
        this.checkEnd();
        this.refresh(true);
    }

    work(due, until) {
        let done = 0;
        while (performance.now() < until && done < due && this.runner.running) {
            const before = this.lab.view.interactions;
            const result = this.lab.tick(Math.min(due - done, BATCH));
            done += this.lab.view.interactions - before;
            if (result === TICK.learnt) {
                this.changed = true;
                this.checkEnd();
                break; // so that each step is seen
            }
        }
        return done;
    }

    // Stops once, where run_gridworld stops.
    checkEnd() {
        const {interactions, schedule, optimal, freeCells, refused} = this.lab.view;
        if (!this.finished && interactions >= schedule) {
            this.finished = true;
            this.stop();
            this.say(`Done: after ${interactions.toLocaleString("en")} interactions the policy is optimal in ${optimal} of ` +
                `${freeCells} cells.${refused ? " The tree is full." : ""} Press Run to go on.`);
        }
    }

    // ---------------------------------------------------------------- what is shown

    say(text, wrong = false) {
        $("say").textContent = text;
        $("say").classList.toggle("wrong", wrong);
    }

    drawn() {
        if (this.changed && (performance.now() > this.refreshed + REFRESH_MS || !this.runner.running)) {
            this.refresh(true);
            return;
        }
        const view = this.lab.view;
        this.say(view.learning ? "A learning step: the tree grows." : "");
        this.view.agent = view.cell;
        this.view.draw();
        this.numbers(view);
    }

    numbers(view) {
        $("interactions").textContent = view.interactions.toLocaleString("en");
        $("optimal").textContent = `${view.optimal} of ${view.freeCells}`;
        $("classes").textContent = view.classes || 1;
        $("bytes").textContent = `${Math.ceil(view.bytes / 1024).toLocaleString("en")} KiB`;
        if (view.episodes !== this.episodes) {
            this.episodes = view.episodes;
            this.charts.returns.show(this.lab.returns.map(([x], i, all) => [x, mean(all.slice(Math.max(0, i - 9), i + 1))]));
        }
    }

    // Draws everything anew, after a learning step.
    refresh(possible) {
        const lab = this.lab, view = lab.view, cells = lab.rows.length * lab.rows[0].length;
        Object.assign(this, {changed: false, refreshed: performance.now(), episodes: -1});
        this.view.side = null;
        this.view.show({rows: lab.rows, agent: possible ? view.cell : -1,
            classes: possible ? lab.classes : new Uint16Array(cells).fill(NO_CLASS),
            actions: possible ? lab.actions : new Uint8Array(cells)});
        if (!possible) {
            return;
        }
        this.shown = lab.tree;
        this.tree.show(this.shown);
        this.select(this.tree.nodes.get(this.tree.chosen) ?? null);
        this.numbers(view);
        this.charts.value.show(lab.history.map((step) => [step.interactions, step.mean]), view.meanOptimal);
        this.charts.classes.show(lab.history.map((step) => [step.interactions, step.classes]));
    }

    // A node was chosen: the cells it separates, its test and its p-value.
    select(node) {
        $("node").replaceChildren(...this.describe(node));
        this.view.showSides(node && this.shown ? sidesOf(this.shown, node, this.view.classes) : null);
    }

    describe(node) {
        if (!node) {
            return [paragraph("Click a node: which cells does it separate, and how sure is that?")];
        }
        if (!("test" in node)) {
            const q = node.q.map((value, action) => `${ARROWS[action]} ${value.toFixed(1)}`).join("   ");
            return [paragraph(`Class ${node.class}: go ${ACTIONS[node.action]}.`, "strong"),
                paragraph(`Expected return by action: ${q}`), paragraph(`Interactions: ${node.samples.join(", ")}`)];
        }
        const evidence = node.action < 4 ? `returns after going ${ACTIONS[node.action]}`
            : node.action === 4 ? "returns of all actions together" : "what is seen next";
        return [paragraph(bitLabel(this.lab, node).long, "strong"),
            paragraph("Cells marked 0 go up in the tree, those marked 1 go down."),
            paragraph(`p = ${probability(node.log_p)} (corrected), by ${evidence}: ${node.samples} samples, in learning ` +
                `step ${node.step}.`), ...(node.node ? [this.enterButton(node.node)] : [])];
    }

    enterButton(number) {
        const button = document.createElement("button"), inside = this.tree.root === number;
        button.textContent = inside ? "Show the whole tree" : "Show from here on";
        button.addEventListener("click", () => {
            this.tree.enter(inside ? 0 : number);
            button.replaceWith(this.enterButton(number));
        });
        return button;
    }

    // ---------------------------------------------------------------- files

    save() {
        const link = document.createElement("a");
        link.href = URL.createObjectURL(new Blob([`${JSON.stringify(this.lab.report(), null, 1)}\n`],
            {type: "application/json"}));
        link.download = "run.json";
        link.click();
        URL.revokeObjectURL(link.href);
    }

    async copy() {
        const text = this.lab.policyC;
        $("policy-c").textContent = text;
        $("policy-box").hidden = false;
        try {
            await navigator.clipboard.writeText(text);
            this.say("Copied: the policy as a C header. It is shown below, too.");
        } catch {
            this.say("The policy as a C header is shown below.");
        }
    }
}

function paragraph(text, kind = "") {
    const element = document.createElement("p");
    element.textContent = text;
    element.className = kind;
    return element;
}

function mean(pairs) {
    return pairs.reduce((sum, pair) => sum + pair[1], 0) / pairs.length;
}
