// SPDX-License-Identifier: MIT
// Starts the page, and changes between its tabs.
"use strict";

class Tabs {
    constructor(opened) {
        this.opened = opened;
        this.buttons = [...document.querySelectorAll("[role=tab]")];
        this.buttons.forEach((button, i) => {
            button.addEventListener("click", () => this.open(i));
            button.addEventListener("keydown", (event) => this.key(event, i));
        });
    }

    key(event, i) {
        const by = {ArrowRight: 1, ArrowLeft: -1}[event.key];
        if (by) {
            const next = (i + by + this.buttons.length) % this.buttons.length;
            this.buttons[next].focus();
            this.open(next);
        }
    }

    open(i) {
        this.buttons.forEach((button, j) => {
            button.setAttribute("aria-selected", i === j);
            button.tabIndex = i === j ? 0 : -1;
            $(button.getAttribute("aria-controls")).hidden = i !== j;
        });
        this.opened(i);
    }
}

async function start() {
    const core = await Core.load(), lab = new MazeLab(core);
    const maze = new MazeTab(lab), cart = new CartTab(core), path = new PathTab(lab);
    const tabs = new Tabs((i) => {
        maze.stop();
        cart.stop();
        [() => maze.refresh(!lab.fault), () => cart.reset(), () => path.open()][i]();
    });
    document.querySelectorAll("[data-tab]").forEach((button) =>
        button.addEventListener("click", () => tabs.open(Number(button.dataset.tab))));
    addEventListener("resize", () => {
        maze.refresh(!lab.fault);
        cart.draw();
        path.view.drawBoard();
    });
    document.body.classList.toggle("embedded", window !== window.parent);
    document.body.dataset.ready = core.version;
    return {lab, maze, cart, path, tabs};
}

const page = start(); // a promise of what there is, also for the browser's console
