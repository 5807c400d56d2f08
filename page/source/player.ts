import { button, choice, fill, labelled, make } from "./dom.js";
import { withUnit } from "./numbers.js";

const [leastSeconds, secondsOfCycle, mostSeconds] = [4, 1.5, 120]; // at usual speed
const steps = 1000;

/** Plays a motion: a button, a slider of time, and a speed. */
export class Player {
  readonly root = make("div", { class: "player", role: "group", "aria-label": "Animation" });
  private readonly toggle = button("▶ Play", () => (this.playing ? this.pause() : this.play()));
  private readonly slider = make("input", { type: "range", min: 0, max: steps, value: 0, "aria-label": "Time" });
  private readonly clock = make("output", { class: "number" });
  private begin = 0;
  private end = 1;
  private time = 0;
  private speed = 1;
  private seconds = leastSeconds; // for the whole motion
  private unit = "";
  private frame = 0;
  private before = 0;

  constructor(private readonly show: (time: number) => void) {
    this.slider.addEventListener("input", () => {
      this.pause();
      this.goTo(this.begin + (Number(this.slider.value) / steps) * (this.end - this.begin));
    });
    const speeds = ["0.1", "0.25", "0.5", "1", "2", "5"].map((value) => ({ value, text: `${value}×` }));
    const speed = choice(speeds, "1", (value) => (this.speed = Number(value)));
    fill(this.root, this.toggle, this.slider, this.clock, labelled("speed", speed));
  }

  get playing(): boolean {
    return this.frame !== 0;
  }

  /** @param cycles of the motion, about; @param keep the time stays if it lies in the motion */
  setMotion(begin: number, end: number, unit: string, cycles: number, keep: boolean): void {
    this.seconds = Math.max(leastSeconds, Math.min(mostSeconds, secondsOfCycle * cycles));
    [this.begin, this.end, this.unit] = [begin, end, unit];
    this.goTo(keep && this.time >= begin && this.time <= end ? this.time : begin);
  }

  pause(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.toggle.textContent = "▶ Play";
  }

  private play(): void {
    this.toggle.textContent = "⏸ Pause";
    this.before = performance.now();
    const advance = (now: number) => {
      if (this.root.offsetParent === null) return this.pause(); // nobody sees it
      const span = this.end - this.begin;
      const time = this.time + ((now - this.before) / 1000) * this.speed * (span / this.seconds);
      this.before = now;
      this.goTo(span > 0 ? this.begin + ((time - this.begin) % span) : this.begin);
      this.frame = requestAnimationFrame(advance);
    };
    this.frame = requestAnimationFrame(advance);
  }

  private goTo(time: number): void {
    this.time = time;
    this.show(time); // first: it reads sizes, which is slow after something is written
    const span = this.end - this.begin;
    this.slider.value = String(span > 0 ? Math.round((steps * (time - this.begin)) / span) : 0);
    const text = withUnit(time, this.unit, 4);
    this.slider.setAttribute("aria-valuetext", text);
    this.clock.textContent = `t = ${text}`;
  }
}
