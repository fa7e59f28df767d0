// SPDX-License-Identifier: MIT
// The second tab: the controller of examples/balance learns to balance a pole; its policy balances one that can be pushed.
"use strict";

const CART = ["~position", "~speed", "~angle", "~turn", "~score", "action", "steps", "falls", "interactions", "episodes",
    "length", "learning", "leaves", "verdict", "bytes"];
const COMPONENTS = ["position", "speed", "angle", "angle's speed"];
const PERIOD_MS = 20;

class CartTab {
    constructor(core) {
        this.core = core;
        this.tree = new TreeView($("cart-tree"), {select: (node) => this.select(node),
            label: (node) => this.label(node), leaf: (node) => ({text: node.action ? "push →" : "← push",
                tint: tintOf(node.action), long: node.action ? "push to the right" : "push to the left"})});
        this.chart = new Chart($("cart-chart"), {title: "Steps before the pole falls, by interactions"});
        this.runner = new Runner({speeds: [50, 500, 5000, 1e9], work: (due, until) => this.work(due, until),
            drawn: () => this.draw()});
        $("cart-run").addEventListener("click", () => this.toggle());
        $("cart-faster").addEventListener("click", () => this.setSpeed(Math.min(this.runner.speed + 1, 3)));
        $("cart-speed").addEventListener("input", () => this.setSpeed(Number($("cart-speed").value)));
        $("cart-reset").addEventListener("click", () => this.reset());
        $("cart-seed").addEventListener("change", () => this.reset());
        $("push-left").addEventListener("click", () => core.exports.cart_push(-0.6));
        $("push-right").addEventListener("click", () => core.exports.cart_push(0.6));
        $("cart-copy").addEventListener("click", () => this.copy());
        this.reset();
    }

    reset() {
        this.stop();
        this.core.exports.cart_new(Number($("cart-seed").value) >>> 0);
        this.lengths = [];
        this.shown = {nodes: [{node: 0, class: 0, action: 0}]};
        this.tree.show(this.shown);
        this.select(null);
        this.clock = performance.now();
        this.draw();
    }

    toggle() {
        if (this.runner.running) {
            this.stop();
            return;
        }
        $("cart-run").textContent = "Pause";
        this.clock = performance.now();
        this.runner.start();
    }

    stop() {
        this.runner.stop();
        $("cart-run").textContent = "Run";
    }

    setSpeed(speed) {
        this.runner.speed = speed;
        $("cart-speed").value = speed;
        $("cart-speed-now").textContent = speed === 3 ? "as fast as it can" : `${this.runner.perSecond / 50} ×`;
    }

    get view() {
        return this.core.struct(this.core.exports.cart_view(), CART);
    }

    // Periods of the control loop; of those that learn, as many as there is time for.
    work(due, until) {
        let done = 0;
        while (performance.now() < until && done < due) {
            const learning = this.view.learning, result = this.core.exports.cart_tick(learning ? 4 : Math.min(due - done, 64));
            done += learning ? 0 : 1;
            if (result === TICK.episodeOver) {
                const view = this.view;
                this.lengths.push([view.interactions, view.length]);
            } else if (result === TICK.learnt) {
                this.learnt();
            }
        }
        return done;
    }

    learnt() {
        if (this.core.exports.cart_tree()) {
            this.shown = JSON.parse(this.core.text());
            this.tree.show(this.shown);
        }
    }

    // "x[2] > 0.0207" is "angle > 0.0207".
    label(node) {
        const [, component, cut] = /x\[(\d+)\] > (\S+)/.exec(node.test), number = Number(cut);
        const text = `${COMPONENTS[component]} > ${number.toPrecision(2)}`;
        return {text, short: text, kind: "number", long: `Is the ${text}? It is ${node.test}.`};
    }

    holds(node, state) {
        const [, component, cut] = /x\[(\d+)\] > (\S+)/.exec(node.test);
        return state[component] > Number(cut);
    }

    select(node) {
        $("cart-node").textContent = !node ? "Click a node to read its test."
            : "test" in node ? `${this.label(node).long} No goes up, yes goes down.`
                : `Push the cart to the ${node.action ? "right" : "left"}.`;
    }

    way(state) {
        const nodes = this.tree.nodes, way = [nodes.get(0)];
        while ("test" in way.at(-1)) {
            way.push(nodes.get(this.holds(way.at(-1), state) ? way.at(-1).present : way.at(-1).absent));
        }
        return way.map((node) => node.node);
    }

    draw() {
        for (const now = performance.now(); this.runner.running && this.clock + PERIOD_MS <= now; this.clock += PERIOD_MS) {
            this.core.exports.cart_show();
        }
        const view = this.view;
        this.drawCart(view);
        this.tree.follow(this.way([view.position, view.speed, view.angle, view.turn]));
        $("cart-interactions").textContent = view.interactions.toLocaleString("en");
        $("cart-episodes").textContent = view.episodes;
        $("cart-leaves").textContent = view.leaves;
        $("cart-steps").textContent = view.steps.toLocaleString("en");
        $("cart-state").textContent = view.learning ? "searching for a better tree" : "trying a tree";
        this.chart.show(this.lengths, 500);
    }

    drawCart({position, angle, action}) {
        const canvas = $("cart"), room = canvas.parentElement.clientWidth, ratio = devicePixelRatio || 1, height = 250;
        if (room === 0) {
            return;
        }
        canvas.width = Math.round(room * ratio);
        canvas.height = Math.round(height * ratio);
        canvas.style.height = `${height}px`;
        const pen = canvas.getContext("2d"), scale = room / 5.4, x = room / 2 + position * scale, y = 196;
        pen.setTransform(ratio, 0, 0, ratio, 0, 0);
        const line = (fromX, fromY, toX, toY, colour, width) => {
            pen.strokeStyle = colour;
            pen.lineWidth = width;
            pen.lineCap = "round";
            pen.beginPath();
            pen.moveTo(fromX, fromY);
            pen.lineTo(toX, toY);
            pen.stroke();
        };
        line(room / 2 - 2.4 * scale, y + 20, room / 2 + 2.4 * scale, y + 20, COLOUR.faint, 3);
        for (const end of [-2.4, 2.4]) {
            line(room / 2 + end * scale, y + 8, room / 2 + end * scale, y + 32, COLOUR.faint, 3);
        }
        pen.fillStyle = COLOUR.wall;
        pen.beginPath();
        pen.roundRect(x - 34, y - 16, 68, 32, 7);
        pen.fill();
        line(x, y - 14, x + Math.sin(angle) * 150, y - 14 - Math.cos(angle) * 150, COLOUR.orange, 9);
        pen.fillStyle = COLOUR.paper;
        pen.beginPath();
        pen.arc(x, y - 14, 4.5, 0, 2 * Math.PI);
        pen.fill();
        const to = action ? 1 : -1;
        line(x + to * 44, y, x + to * 66, y, COLOUR.blue, 4);
        line(x + to * 58, y - 7, x + to * 66, y, COLOUR.blue, 4);
        line(x + to * 58, y + 7, x + to * 66, y, COLOUR.blue, 4);
    }

    async copy() {
        if (!this.core.exports.cart_policy_c()) {
            return;
        }
        const text = this.core.text();
        $("cart-c").textContent = text;
        $("cart-box").hidden = false;
        await navigator.clipboard?.writeText(text).catch(() => {});
    }
}
