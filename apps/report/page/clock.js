// The one time of a record: the slider, the plots and the animation all read it and listen to it.
//
// Played, it advances by dt = speed * s(t) * (wall time), with s = 1, or near events, where slow motion is on,
//     s(t) = max(d / w, 1 / 25),     d: distance to the nearest event,   w: 3 % of the record, at most 0.25 s

const kSlowest = 1 / 25;

export class Clock {
  constructor(start, end, events) {
    Object.assign(this, {start, end, t: start, events, playing: false, speed: 1, slow: events.length > 0});
    this.width = Math.min(0.25, 0.03 * (end - start)) || 1;
    this.listeners = new Set();
    this.last = 0;
  }

  /// `listener(clock)` is called whenever anything of the clock has changed.
  listen(listener) {
    this.listeners.add(listener);
    listener(this);
  }

  tell() {
    for (const listener of this.listeners) listener(this);
  }

  go(t) {
    this.t = Math.min(this.end, Math.max(this.start, t));
    this.tell();
  }

  setSpeed(speed) {
    this.speed = speed;
    this.tell();
  }

  setSlow(slow) {
    this.slow = slow;
    this.tell();
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && this.t >= this.end) this.t = this.start;
    this.tell();
    if (!this.playing) return;
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.playing) return;
    const wall = Math.min(0.1, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    this.t = Math.min(this.end, this.t + wall * this.speed * this.slowness());
    if (this.t >= this.end) this.playing = false;
    this.tell();
    if (this.playing) requestAnimationFrame((next) => this.tick(next));
  }

  slowness() {
    if (!this.slow) return 1;
    let nearest = Infinity;
    for (const event of this.events) nearest = Math.min(nearest, Math.abs(event - this.t));
    return Math.min(1, Math.max(kSlowest, nearest / this.width));
  }

  /// To the next event, or with direction -1 to the one before.
  jump(direction) {
    const small = 1e-9 * (this.end - this.start);
    const ahead = this.events.filter((event) => direction * (event - this.t) > small);
    if (ahead.length > 0) this.go(direction > 0 ? Math.min(...ahead) : Math.max(...ahead));
  }
}
