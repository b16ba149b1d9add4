// The time of what is shown, and how fast it goes on.

export const SPEEDS = [1, 0.5, 0.25, 0.1, 0.05, 0.02];

export class Clock {
  #listeners = [];
  #last = 0;

  constructor() {
    Object.assign(this, { time: 0, start: 0, end: 1, speed: 1, playing: false });
  }

  /** Call `listener` after every change of time, speed, or playing. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  range(start, end) {
    Object.assign(this, { start, end });
    this.seek(this.time);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.#changed();
  }

  /** A step that people make: it stops the motion. */
  step(by) {
    this.playing = false;
    this.seek(this.time + by);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.#changed();
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing) {
      if (this.time >= this.end) this.time = this.start;
      this.#last = performance.now();
      requestAnimationFrame((now) => this.#tick(now));
    }
    this.#changed();
  }

  #tick(now) {
    if (!this.playing) return;
    const passed = Math.max(0, Math.min(now - this.#last, 250)) / 1000; // a hidden tab has stopped
    this.#last = now;
    if (this.time + passed * this.speed >= this.end) this.playing = false;
    else requestAnimationFrame((next) => this.#tick(next));
    this.seek(this.time + passed * this.speed);
  }

  #changed() {
    for (const listener of this.#listeners) listener(this);
  }
}
