// SPDX-License-Identifier: MIT
// The third tab: one decision. A cell is seen as bits, and some of the bits lead through the tree.
"use strict";

class PathTab {
    constructor(lab) {
        this.lab = lab;
        this.draw = 0;
        this.cell = -1;
        this.view = new MazeView($("path-maze"), {hover: (cell) => this.hover(cell)});
        this.view.ring = true;
        this.tree = new TreeView($("path-tree"), {select: () => {}, label: (node) => bitLabel(lab, node),
            leaf: (node) => ({...classLabel(node), text: ARROWS[node.action], long: `go ${ACTIONS[node.action]}`})});
        $("path-which").addEventListener("change", () => this.open());
        $("path-again").addEventListener("click", () => this.look());
    }

    // Shows the tree as it is now.
    open() {
        if (this.lab.fault) {
            return;
        }
        const whole = $("path-which").value === "classes";
        this.shown = (whole ? null : this.lab.policy) ?? this.lab.tree;
        const view = this.lab.view;
        this.view.show({rows: this.lab.rows, classes: this.lab.classes, actions: this.lab.actions, agent: -1});
        this.tree.show(this.shown);
        this.cell = this.cell >= 0 && this.cell < view.width * view.height && this.view.signAt(this.cell) === "." ? this.cell
            : this.lab.rows.join("").indexOf(".");
        this.look();
    }

    hover(cell) {
        if (cell !== this.cell && this.view.signAt(cell) === ".") {
            this.cell = cell;
            this.look();
        }
    }

    // Another percept of the cell, and its way through the tree.
    look() {
        const bits = this.lab.percept(this.cell, ++this.draw), way = this.way(bits);
        this.tree.follow(way.map((node) => node.node));
        this.view.agent = this.cell;
        this.view.draw();
        const tested = new Set(way.filter((node) => "test" in node).map((node) => Number(node.test.slice(4))));
        $("percept").replaceChildren(...bits.map((bit, i) => this.bit(bit, i, tested)));
        const width = this.view.width, leaf = way.at(-1);
        $("decision").textContent = `Cell x = ${this.cell % width}, y = ${Math.floor(this.cell / width)}: ` +
            way.slice(0, -1).map((node) => `${node.test} is ${bits[Number(node.test.slice(4))]}`).concat(
                `so go ${ACTIONS[leaf.action]}`).join(", ") + ".";
    }

    way(bits) {
        const nodes = this.tree.nodes, way = [nodes.get(0)];
        while ("test" in way.at(-1)) {
            const node = way.at(-1);
            way.push(nodes.get(bits[Number(node.test.slice(4))] ? node.present : node.absent));
        }
        return way;
    }

    bit(value, number, tested) {
        const element = document.createElement("span"), {kind, worth} = this.lab.meaning(number);
        element.className = `bit ${kind} ${value ? "set" : ""} ${tested.has(number) ? "tested" : ""}`;
        element.title = `bit ${number}: ${kind === "noise" ? "random" : `${kind}, worth ${worth}`}`;
        const index = document.createElement("small");
        index.textContent = number;
        element.append(String(value), index);
        return element;
    }
}
