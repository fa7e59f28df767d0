// SPDX-License-Identifier: MIT
// A small line chart on a canvas: a title, the last value, two axes.
"use strict";

class Chart {
    constructor(canvas, {title, colour = COLOUR.blue, steps = false, digits = 0}) {
        Object.assign(this, {canvas, title, colour, steps, digits});
    }

    // points: [[x, y], ...]; goal: a value that a dashed line marks, or null.
    show(points, goal = null) {
        const room = this.canvas.parentElement.clientWidth, ratio = devicePixelRatio || 1, width = room, height = 108;
        if (room === 0) {
            return;
        }
        this.canvas.width = Math.round(width * ratio);
        this.canvas.height = Math.round(height * ratio);
        this.canvas.style.height = `${height}px`;
        const pen = this.canvas.getContext("2d");
        pen.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.frame = {left: 40, right: width - 8, top: 30, bottom: height - 18};
        this.limits(points, goal);
        this.axes(pen, points, goal);
        if (points.length) {
            this.line(pen, points);
        }
    }

    limits(points, goal) {
        const values = points.map((point) => point[1]).concat(goal === null ? [] : [goal]);
        this.low = Math.min(0, ...values);
        this.high = Math.max(this.low + 1, ...values);
        this.last = points.length ? Math.max(points.at(-1)[0], 1) : 1;
    }

    x(value) {
        return this.frame.left + (this.frame.right - this.frame.left) * value / this.last;
    }

    y(value) {
        return this.frame.bottom - (this.frame.bottom - this.frame.top) * (value - this.low) / (this.high - this.low);
    }

    axes(pen, points, goal) {
        const {left, right, top, bottom} = this.frame, write = (text, x, y, align, weight, colour) => {
            pen.font = `${weight} 12px system-ui, sans-serif`;
            pen.fillStyle = colour;
            pen.textAlign = align;
            pen.textBaseline = "middle";
            pen.fillText(text, x, y);
        };
        write(this.title, 2, 12, "left", 600, COLOUR.ink);
        if (points.length) {
            write(points.at(-1)[1].toFixed(this.digits), right, 12, "right", 600, this.colour);
            write(this.last.toLocaleString("en"), right, bottom + 11, "right", 400, "#5a6572");
        }
        write("0", left, bottom + 11, "center", 400, "#5a6572");
        write(this.high.toFixed(0), left - 6, top, "right", 400, "#5a6572");
        write(this.low.toFixed(0), left - 6, bottom, "right", 400, "#5a6572");
        pen.lineWidth = 1;
        pen.strokeStyle = COLOUR.line;
        pen.strokeRect(left, top, right - left, bottom - top);
        if (goal !== null) {
            pen.setLineDash([5, 4]);
            pen.strokeStyle = COLOUR.exit;
            pen.beginPath();
            pen.moveTo(left, this.y(goal));
            pen.lineTo(right, this.y(goal));
            pen.stroke();
            pen.setLineDash([]);
        }
    }

    line(pen, points) {
        const every = Math.max(1, Math.floor(points.length / 600));
        pen.strokeStyle = this.colour;
        pen.lineWidth = 1.8;
        pen.beginPath();
        points.forEach(([x, y], i) => {
            if (i % every && i + 1 < points.length) {
                return;
            }
            if (this.steps && i) {
                pen.lineTo(this.x(x), this.y(points[i - 1][1]));
            }
            pen[i ? "lineTo" : "moveTo"](this.x(x), this.y(y));
        });
        pen.stroke();
    }
}
