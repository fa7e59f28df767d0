// SPDX-License-Identifier: MIT
// The core as a WebAssembly module (wasm.js holds it): how numbers and text pass between it and the page.
//
// Views are made anew at each reading, as the module's memory moves when it grows.
"use strict";

class Core {
    static async load() {
        const bytes = Uint8Array.from(atob(WASM), (sign) => sign.charCodeAt(0));
        const {instance} = await WebAssembly.instantiate(bytes, {});
        return new Core(instance.exports);
    }

    constructor(exports) {
        this.exports = exports;
    }

    get version() {
        this.exports.version();
        return this.text();
    }

    bytes(at, count) {
        return new Uint8Array(this.exports.memory.buffer, at, count);
    }

    // The struct at this address, whose members are 32-bit numbers: {name: value}. Names of floats begin with "~".
    struct(at, names) {
        const view = new DataView(this.exports.memory.buffer, at, 4 * names.length);
        return Object.fromEntries(names.map((name, i) => name.startsWith("~")
            ? [name.slice(1), view.getFloat32(4 * i, true)] : [name, view.getUint32(4 * i, true)]));
    }

    // What a function of the module wrote last.
    text() {
        return new TextDecoder().decode(this.bytes(this.exports.text_start(), this.exports.text_bytes()));
    }

    // Text for a function of the module to read.
    write(text) {
        const bytes = new TextEncoder().encode(text);
        this.exports.text_take(bytes.length);
        this.bytes(this.exports.text_start(), bytes.length).set(bytes);
    }
}

// What a tick returns.
const TICK = {on: 0, episodeOver: 1, learnt: 2, failed: 3};
