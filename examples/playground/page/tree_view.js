// SPDX-License-Identifier: MIT
// A tree as SVG, its root to the left: a branch up where a test fails, down where it holds. Nodes can be clicked and
// reached by the keyboard. Of a large tree the parts farthest from the root are folded.
"use strict";

const MOST_LEAVES = 72; // drawn at once
const SVG = "http://www.w3.org/2000/svg";

function svg(name, attributes, parent, text) {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) {
        element.setAttribute(key, value);
    }
    if (text !== undefined) {
        element.textContent = text;
    }
    parent?.append(element);
    return element;
}

class TreeView {
    // `select(node)` is called with the node that was chosen, or null. `label(node)` gives {text, kind} of a test,
    // `leaf(node)` {text, tint} of a leaf.
    constructor(element, {select, label, leaf}) {
        Object.assign(this, {element, select, label, leaf, chosen: -1, root: 0, path: new Set(), nodes: new Map()});
    }

    // Shows a tree as the library prints it in JSON.
    show(tree) {
        this.nodes = new Map(tree.nodes.map((node) => [node.node, node]));
        if (!this.nodes.has(this.root)) {
            this.root = 0;
        }
        this.draw();
    }

    // Draws from this node on.
    enter(number) {
        this.root = number;
        this.draw();
    }

    choose(number) {
        this.chosen = number === this.chosen ? -1 : number;
        for (const group of this.element.querySelectorAll("g[data-node]")) {
            const pressed = Number(group.dataset.node) === this.chosen;
            group.setAttribute("aria-pressed", pressed);
            group.classList.toggle("chosen", pressed);
        }
        this.select(this.nodes.get(this.chosen) ?? null);
    }

    // Marks the nodes that a decision comes by.
    follow(numbers) {
        this.path = new Set(numbers);
        for (const element of this.element.querySelectorAll("[data-to]")) {
            element.classList.toggle("on", this.path.has(Number(element.dataset.to)));
        }
    }

    children(node) {
        return "test" in node ? [this.nodes.get(node.absent), this.nodes.get(node.present)] : [];
    }

    leavesBelow(node) {
        let leaves = 0;
        for (const open = [node]; open.length;) {
            const below = this.children(open.pop());
            leaves += below.length ? 0 : 1;
            open.push(...below);
        }
        return leaves;
    }

    // Which nodes are unfolded: those nearest to the root, as many as there is room for.
    unfolded() {
        const open = new Set(), queue = [this.nodes.get(this.root)];
        let leaves = 1;
        for (let i = 0; i < queue.length && leaves < MOST_LEAVES; i++) {
            if ("test" in queue[i]) {
                open.add(queue[i].node);
                leaves++;
                queue.push(...this.children(queue[i]));
            }
        }
        return open;
    }

    // Places by depth and by row: [{node, depth, row, folded}], and how deep and high all is.
    layout() {
        const open = this.unfolded(), places = [];
        let rows = 0, deepest = 0;
        const place = (node, depth) => {
            deepest = Math.max(deepest, depth);
            const here = {node, depth, row: 0, folded: "test" in node && !open.has(node.node), below: []};
            places.push(here);
            if (open.has(node.node)) {
                here.below = this.children(node).map((child) => place(child, depth + 1));
                here.row = (here.below[0].row + here.below[1].row) / 2;
            } else {
                here.row = rows++;
            }
            return here;
        };
        place(this.nodes.get(this.root), 0);
        return {places, rows, deepest};
    }

    draw() {
        const {places, rows, deepest} = this.layout(), room = this.element.clientWidth || 400;
        const longest = Math.max(...places.map(({node}) => "test" in node ? this.label(node).text.length : 0));
        const high = Math.min(Math.max(460 / rows, 14), 34), left = 10 + longest * 4, last = 66;
        const wide = Math.min(Math.max((room - last - left) / Math.max(deepest, 1), 30), 48 + longest * 8);
        const width = left + deepest * wide + last, height = rows * high + 14;
        const at = (place) => [left + place.depth * wide, 7 + (place.row + 0.5) * high];
        const drawing = svg("svg", {width, height, viewBox: `0 0 ${width} ${height}`, role: "group",
            "aria-label": "The learnt tree"});
        const lines = svg("g", {}, drawing);
        for (const place of places) {
            place.below.forEach((child, side) => this.drawBranch(lines, at(place), at(child), side, child.node.node));
        }
        places.forEach((place) => this.drawNode(drawing, place, at(place), wide, high));
        this.element.replaceChildren(drawing);
    }

    drawBranch(parent, [x, y], [toX, toY], side, to) {
        const middle = (x + toX) / 2;
        svg("path", {d: `M${x} ${y}C${middle} ${y} ${middle} ${toY} ${toX} ${toY}`, "data-to": to,
            class: `branch ${side ? "present" : "absent"} ${this.path.has(to) ? "on" : ""}`}, parent);
    }

    drawNode(parent, place, [x, y], wide, high) {
        const {node, folded} = place, test = "test" in node, number = node.node;
        const label = folded ? {text: `${this.leavesBelow(node)} classes`, kind: "folded"}
            : test ? this.label(node) : this.leaf(node);
        const group = svg("g", {"data-node": number, "data-to": number, tabindex: 0, role: "button",
            "aria-pressed": number === this.chosen, "aria-label": label.long ?? label.text,
            class: `node ${label.kind ?? "leaf"} ${number === this.chosen ? "chosen" : ""} ${this.path.has(number) ? "on" : ""}`},
        parent);
        const tall = Math.min(high - 2, 22), size = Math.min(tall * 0.72, 12.5);
        const text = test && !folded && wide < 46 ? label.short ?? label.text : label.text;
        const long = text.length * size * 0.56 + 10, left = test && !folded ? x - long / 2 : x - 8;
        svg("title", {}, group, label.long ?? label.text);
        svg("rect", {x: left, y: y - tall / 2, width: long, height: tall, rx: test ? tall / 2 : 4,
            ...(label.tint ? {style: `fill:${label.tint}`} : {})}, group);
        svg("text", {x: left + long / 2, y: y + size * 0.36, "font-size": size}, group, text);
        group.addEventListener("click", () => this.choose(number));
        group.addEventListener("keydown", (event) => {
            if (event.key === "Enter" || event.key === " ") {
                event.preventDefault();
                this.choose(number);
            }
        });
    }
}
