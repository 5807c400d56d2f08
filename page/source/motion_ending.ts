import type { Motion } from "./contract.js";
import { withUnit } from "./numbers.js";

const endings: Record<string, string> = {
  terminal: "the model ends it there",
  singular: "the solution ceases to exist",
  undefined: "the equations have no finite value there",
  inadmissible: "the state is behind a barrier, such as a wall",
  "no-transition": "nothing is said about what follows the event",
  chatter: "contacts accumulate, and the model has no sticking",
  "no-separation": "after its jump the barrier is still approached",
  "no-progress": "too many events happen at one time",
  "two-fold": "sliding ends towards both sides at once",
  painleve: "contact forces with friction are not determined",
  "step-limit": "it takes too many steps",
};

const limits: Record<string, string> = {
  steps: "it takes too many steps; choose a shorter duration",
  seconds: "it takes too long to compute; choose a shorter duration",
  interrupted: "the server ends",
};

/** Why a motion ends before the time that was asked for; empty if it does not. */
export function endingWords(motion: Motion): string {
  const why = [limits[motion.limit ?? ""] ?? (motion.limit || endings[motion.ending]), motion.detail]
    .filter((text, index, all) => text && all.indexOf(text) === index)
    .join(": ");
  const early = !motion.complete || motion.ending in endings;
  if (!early) return "";
  const times = motion.values[0] ?? [];
  if (times.length < 2) return `There is no motion: ${why || motion.ending}.`;
  const end = withUnit(times[times.length - 1], motion.columns[0].unit, 5);
  if (motion.ending === "singular" && !motion.limit)
    return `Snap-through at t = ${end}: the solution ceases to exist${motion.detail ? ` (${motion.detail})` : ""}.`;
  return `The motion ends early, at t = ${end}: ${why || motion.ending}.`;
}
