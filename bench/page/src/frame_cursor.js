// SPDX-License-Identifier: MIT

/** The frame of a scene that is looked at; pictures follow it. */
export class FrameCursor {
  #frame = 0;
  #listeners = [];

  constructor(last) {
    this.last = last;
  }

  get frame() {
    return this.#frame;
  }

  /** A frame from 0 to last; parts of one while it plays. */
  set(frame) {
    this.#frame = Math.min(this.last, Math.max(0, frame));
    for (const listener of this.#listeners) listener(this.#frame);
  }

  follow(listener) {
    this.#listeners.push(listener);
  }
}
