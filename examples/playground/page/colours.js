// SPDX-License-Identifier: MIT
// Colours that people with any colour vision tell apart (Okabe and Ito), and signs that say the same without colour.
"use strict";

const COLOUR = {ink: "#1c2530", faint: "#8b95a1", line: "#d5dbe2", wall: "#39424e", exit: "#009e73", blue: "#0072b2",
    orange: "#d55e00", paper: "#ffffff", accent: "#0b5fa5"};
const TINTS = ["#cfe6f5", "#fde3c1", "#cdeee2", "#f6d3e4", "#fbf3ba", "#dcd6f2", "#f9d4c4", "#dfe5ea"];

const tintOf = (classId) => TINTS[classId % TINTS.length];
const ARROWS = ["↑", "→", "↓", "←"];
