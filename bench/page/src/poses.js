// SPDX-License-Identifier: MIT
// The motion of a scene, as the tool packed it.
import { Quaternion, Vector3 } from "three";

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** The frames that a solver's replay has kept. */
export class Poses {
  #replay; #frames; #counts; #firsts = []; #poses; #errors;
  #a = { p: new Vector3(), q: new Quaternion() };
  #b = { p: new Vector3(), q: new Quaternion() };

  constructor(replay, solver) {
    this.#replay = replay;
    this.#frames = solver.frames;
    this.#counts = solver.counts;
    let first = 0;
    for (const count of solver.counts) {
      this.#firsts.push(first);
      first += count;
    }
    this.#poses = new DataView(bytesOf(solver.poses).buffer);
    this.#errors = bytesOf(solver.errors);
  }

  /** The kept frame at or before a time in frames, and how far it is on to the next. */
  #stopAt(frame) {
    let stop = this.#frames.findLastIndex((f) => f <= frame);
    if (stop < 0) stop = 0;
    const next = Math.min(stop + 1, this.#frames.length - 1);
    const gap = this.#frames[next] - this.#frames[stop];
    return { stop, next, share: gap > 0 ? Math.min(1, (frame - this.#frames[stop]) / gap) : 0 };
  }

  #read(stop, body, pose) {
    const at = 12 * (this.#firsts[stop] + body);
    const number = (i) => this.#poses.getInt16(at + 2 * i, true) / 32767;
    const { low, side } = this.#replay;
    pose.p.set(...[0, 1, 2].map((i) => low[i] + ((number(i) + 1) / 2) * side));
    const [x, y, z] = [number(3), number(4), number(5)];
    pose.q.set(x, y, z, Math.sqrt(Math.max(0, 1 - x * x - y * y - z * z))).normalize();
  }

  get last() {
    return this.#frames.at(-1) ?? 0;
  }

  /**
   * Calls visit(body, position, rotation, error) for every body; error in [0, 1] is where it is on
   * the logarithmic scale.
   */
  at(frame, visit) {
    const { stop, next, share } = this.#stopAt(frame);
    if (this.#frames.length === 0) return;
    const count = Math.min(this.#counts[stop], this.#counts[next]);
    for (let body = 0; body < count; ++body) {
      this.#read(stop, body, this.#a);
      this.#read(next, body, this.#b);
      this.#a.p.lerp(this.#b.p, share);
      this.#a.q.slerp(this.#b.q, share);
      visit(body, this.#a.p, this.#a.q, this.#errors[this.#firsts[share > 0.5 ? next : stop] + body] / 255);
    }
  }
}
