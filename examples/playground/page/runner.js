// SPDX-License-Identifier: MIT
// The clock of a tab: calls `work(due, until)` in each frame, which does at most `due` units before the time `until`
// and returns how many it did, and then `drawn()`.
"use strict";

const SLICE_MS = 12; // of a frame of 16: the rest is for drawing

class Runner {
    constructor({speeds, work, drawn}) {
        Object.assign(this, {speeds, work, drawn, speed: 1, running: false, due: 0, before: 0, frames: 0});
    }

    get perSecond() {
        return this.speeds[this.speed];
    }

    start() {
        if (!this.running) {
            this.running = true;
            this.due = 0;
            this.before = performance.now();
            requestAnimationFrame((now) => this.frame(now));
        }
    }

    stop() {
        this.running = false;
    }

    frame(now) {
        if (!this.running) {
            return;
        }
        const elapsed = Math.min(Math.max(now - this.before, 0), 100) / 1000;
        this.before = now;
        this.due = Math.min(this.due + elapsed * this.perSecond, 1e6);
        this.due -= this.work(Math.floor(this.due), performance.now() + SLICE_MS);
        this.frames++;
        this.drawn();
        requestAnimationFrame((next) => this.frame(next));
    }
}
