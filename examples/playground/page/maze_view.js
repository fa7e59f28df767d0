// SPDX-License-Identifier: MIT
// The maze on a canvas: walls, classes, arrows, the agent. One draws walls with mouse, finger or keys.
"use strict";

const DIRECTIONS = [[0, -1], [1, 0], [0, 1], [-1, 0]];
const KEYS = {ArrowUp: 0, ArrowRight: 1, ArrowDown: 2, ArrowLeft: 3};

class MazeView {
    // `edit(cell, sign)` is called for each cell that is drawn on, `hover(cell)` for the one under the pointer or the
    // cursor. Either may be null.
    constructor(canvas, {edit = null, hover = null}) {
        Object.assign(this, {canvas, edit, hover, tool: "#", brush: "#", cursor: -1, drawing: false, side: null, ring: false,
            board: document.createElement("canvas")});
        canvas.tabIndex = 0;
        canvas.addEventListener("pointerdown", (event) => this.press(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        canvas.addEventListener("pointerup", () => { this.drawing = false; });
        canvas.addEventListener("pointercancel", () => { this.drawing = false; });
        canvas.addEventListener("keydown", (event) => this.key(event));
        canvas.addEventListener("blur", () => { this.cursor = -1; this.draw(); });
    }

    // ---------------------------------------------------------------- input

    cellAt(event) {
        const box = this.canvas.getBoundingClientRect();
        const x = Math.floor((event.clientX - box.left) / this.size), y = Math.floor((event.clientY - box.top) / this.size);
        return x >= 0 && y >= 0 && x < this.width && y < this.rows.length ? y * this.width + x : -1;
    }

    signAt(cell) {
        return this.rows[Math.floor(cell / this.width)][cell % this.width];
    }

    press(event) {
        const cell = this.cellAt(event);
        if (cell < 0) {
            return;
        }
        this.hover?.(cell);
        if (this.edit) {
            event.preventDefault();
            this.canvas.setPointerCapture(event.pointerId);
            this.drawing = true;
            this.brush = this.signAt(cell) === this.tool ? "." : this.tool;
            this.paint(cell);
        }
    }

    move(event) {
        const cell = this.cellAt(event);
        if (cell < 0) {
            return;
        }
        if (this.drawing) {
            this.paint(cell);
        } else {
            this.hover?.(cell);
        }
    }

    paint(cell) {
        if (this.signAt(cell) !== this.brush) {
            this.edit(cell, this.brush);
        }
    }

    key(event) {
        if (event.key in KEYS) {
            const [dx, dy] = DIRECTIONS[KEYS[event.key]], from = Math.max(this.cursor, 0);
            const x = Math.min(Math.max(from % this.width + dx, 0), this.width - 1);
            const y = Math.min(Math.max(Math.floor(from / this.width) + dy, 0), this.rows.length - 1);
            this.cursor = this.cursor < 0 ? 0 : y * this.width + x;
            this.hover?.(this.cursor);
        } else if ((event.key === " " || event.key === "Enter") && this.edit && this.cursor >= 0) {
            this.brush = this.signAt(this.cursor) === this.tool ? "." : this.tool;
            this.paint(this.cursor);
        } else {
            return;
        }
        event.preventDefault();
        this.draw();
    }

    // ---------------------------------------------------------------- drawing

    // What is to be drawn: rows of signs, classes and actions by cell, the cell of the agent (-1: none).
    show({rows, classes, actions, agent}) {
        Object.assign(this, {rows, classes, actions, agent, width: rows[0].length});
        this.drawBoard();
    }

    // Cells on the two sides of a test: 0 or 1 by cell, or nothing. null: show classes.
    showSides(side) {
        this.side = side;
        this.drawBoard();
    }

    // All that changes with a learning step only is drawn once, beside the screen.
    drawBoard() {
        if (!this.rows || this.canvas.parentElement.clientWidth === 0) {
            return; // in a tab that is not shown
        }
        const pen = this.fit(this.board);
        for (let cell = 0; cell < this.width * this.rows.length; cell++) {
            this.drawCell(pen, cell, cell % this.width * this.size, Math.floor(cell / this.width) * this.size);
        }
        this.drawBorders(pen);
        this.draw();
    }

    // A canvas gets the size that there is room for. Returns its pen.
    fit(canvas) {
        const room = this.canvas.parentElement.clientWidth, height = Math.max(320, Math.min(innerHeight * 0.62, 560));
        const size = Math.max(6, Math.floor(Math.min(room / this.width, height / this.rows.length, 64)));
        const ratio = devicePixelRatio || 1, w = size * this.width, h = size * this.rows.length;
        if (canvas.width !== Math.round(w * ratio) || canvas.height !== Math.round(h * ratio)) {
            canvas.width = Math.round(w * ratio);
            canvas.height = Math.round(h * ratio);
            canvas.style.width = `${w}px`;
            canvas.style.height = `${h}px`;
        }
        this.size = size;
        const pen = canvas.getContext("2d");
        pen.setTransform(ratio, 0, 0, ratio, 0, 0);
        return pen;
    }

    draw() {
        if (!this.rows || this.canvas.parentElement.clientWidth === 0) {
            return;
        }
        const pen = this.fit(this.canvas);
        pen.drawImage(this.board, 0, 0, this.size * this.width, this.size * this.rows.length);
        if (this.agent >= 0) {
            this.drawAgent(pen, this.agent);
        }
        if (this.cursor >= 0) {
            pen.strokeStyle = COLOUR.ink;
            pen.lineWidth = 3;
            pen.strokeRect(this.cursor % this.width * this.size + 1.5, Math.floor(this.cursor / this.width) * this.size + 1.5,
                this.size - 3, this.size - 3);
        }
    }

    fillOf(cell, sign) {
        if (sign !== ".") {
            return sign === "#" ? COLOUR.wall : COLOUR.exit;
        }
        if (this.side) {
            return this.side[cell] === 1 ? "#f6c9a8" : this.side[cell] === 0 ? "#b9daf0" : "#f4f6f8";
        }
        const classId = this.classes[cell];
        return classId >= MIXED ? COLOUR.paper : tintOf(classId);
    }

    drawCell(pen, cell, x, y) {
        const sign = this.signAt(cell), size = this.size;
        pen.fillStyle = this.fillOf(cell, sign);
        pen.fillRect(x, y, size, size);
        if (sign === "*") {
            this.write(pen, size >= 40 ? "exit" : "✕", x + size / 2, y + size / 2, Math.min(size * 0.36, 15), "#ffffff", 700);
        } else if (sign === ".") {
            this.drawPolicy(pen, cell, x, y);
        }
    }

    drawPolicy(pen, cell, x, y) {
        const size = this.size, side = this.side?.[cell], classId = this.classes[cell];
        if (this.side) {
            if (side !== undefined && size >= 12) {
                this.write(pen, String(side), x + size / 2, y + size / 2, size * 0.42, side ? "#8f3d00" : "#00507d", 700);
            }
            return;
        }
        this.drawArrow(pen, x + size / 2, y + size / 2 + (size >= 30 ? size * 0.08 : 0), size, this.actions[cell]);
        if (size >= 30 && classId < MIXED) {
            this.write(pen, String(classId), x + 4, y + 9, 10.5, "#55606d", 400, "left");
        }
    }

    drawArrow(pen, x, y, size, action) {
        const [dx, dy] = DIRECTIONS[action], reach = size * 0.25, head = size * 0.13;
        pen.strokeStyle = COLOUR.ink;
        pen.lineWidth = Math.max(1, size * 0.045);
        pen.lineCap = "round";
        pen.beginPath();
        pen.moveTo(x - dx * reach, y - dy * reach);
        pen.lineTo(x + dx * reach, y + dy * reach);
        pen.moveTo(x + dx * (reach - head) - dy * head, y + dy * (reach - head) + dx * head);
        pen.lineTo(x + dx * reach, y + dy * reach);
        pen.lineTo(x + dx * (reach - head) + dy * head, y + dy * (reach - head) - dx * head);
        pen.stroke();
    }

    // A line between cells of different classes, so that nobody has to tell tints apart.
    drawBorders(pen) {
        const {width, size, rows} = this, key = (cell) => this.side ? this.side[cell] : this.classes[cell];
        const strokes = [[[], "rgba(28,37,48,.10)", 1], [[], "rgba(28,37,48,.55)", Math.max(1, size / 36)]];
        for (let cell = 0; cell < width * rows.length; cell++) {
            const x = cell % width, y = Math.floor(cell / width);
            if (x + 1 < width) {
                strokes[key(cell) === key(cell + 1) ? 0 : 1][0].push([(x + 1) * size, y * size, 0, size]);
            }
            if (y + 1 < rows.length) {
                strokes[key(cell) === key(cell + width) ? 0 : 1][0].push([x * size, (y + 1) * size, size, 0]);
            }
        }
        for (const [lines, colour, thickness] of strokes) {
            pen.strokeStyle = colour;
            pen.lineWidth = thickness;
            pen.beginPath();
            for (const [x, y, dx, dy] of lines) {
                pen.moveTo(x, y);
                pen.lineTo(x + dx, y + dy);
            }
            pen.stroke();
        }
        pen.strokeStyle = COLOUR.wall;
        pen.lineWidth = 2;
        pen.strokeRect(1, 1, width * size - 2, rows.length * size - 2);
    }

    drawAgent(pen, cell) {
        const x = (cell % this.width + 0.5) * this.size, y = (Math.floor(cell / this.width) + 0.5) * this.size;
        pen.beginPath();
        if (this.ring) { // the arrow below it is to be seen
            pen.lineWidth = Math.max(3, this.size * 0.09);
            pen.strokeStyle = COLOUR.accent;
            pen.arc(x, y, this.size * 0.42, 0, 2 * Math.PI);
            pen.stroke();
            return;
        }
        pen.arc(x, y, this.size * 0.26, 0, 2 * Math.PI);
        pen.fillStyle = COLOUR.accent;
        pen.fill();
        pen.lineWidth = Math.max(1.5, this.size * 0.06);
        pen.strokeStyle = "#ffffff";
        pen.stroke();
    }

    write(pen, text, x, y, size, colour, weight, align = "center") {
        pen.font = `${weight} ${size}px system-ui, sans-serif`;
        pen.fillStyle = colour;
        pen.textAlign = align;
        pen.textBaseline = "middle";
        pen.fillText(text, x, y);
    }
}
