// The answers of the server, as docs/page-interface.md describes them. Numbers that are not finite come as null.

export type Num = number | null;

export interface Session {
  version: string;
  title: string;
  opened: { kind: "results" | "study" | "model"; name: string };
  can_compute: boolean;
  results: string | null | boolean;
  stored: boolean;
}

export interface Quantity {
  name: string;
  unit: string;
  words: string;
}

export interface Run {
  name: string;
  kind: string;
  kind_words: string;
  model: string;
  status: "complete" | "unfinished" | "failed" | "missing" | "outdated";
  failure: string | null;
  remedy: string | null;
  points: number;
  planned: number | null;
  labels: [string, number][];
  ends: [string, string][];
  directions: string[];
  parts: string[];
  samplings: string[];
  coordinates: Quantity[];
  values: Quantity[];
  states: Quantity[];
  is_branch: boolean;
  is_followed: boolean;
  seeks_attractors: boolean;
  revision: number | string;
}

export interface StudyPicture {
  name: string;
  kind: string;
  title: string;
  runs: string[];
  over?: string[];
  x?: string;
  y?: string[];
  samples?: string[];
  directions?: string[];
  points?: string[];
}

/** A picture that is asked for: the name of one of the study, or keys of a [pictures.NAME] table. */
export interface PictureWish extends Partial<StudyPicture> {
  at?: Record<string, number>[];
  logarithmic?: string[];
  x_range?: [number, number];
  y_range?: [number, number];
}

export interface Axis {
  label: string;
  unit: string;
  words: string;
  logarithmic: boolean;
  range: [number, number] | null;
}

export type SeriesStyle = "dots" | "circles" | "line" | "dashed" | "dotted" | "impulses" | "symbols" | "cells";
export type ColourName = number | "grey" | "black";

export interface Series {
  title: string;
  style: SeriesStyle;
  colour: ColourName;
  symbol?: number;
  only_in_legend?: boolean;
  hatch?: number;
  x: Num[];
  y: Num[];
  cells?: [number, number, number, number][];
  along?: Num[]; // arclength of each point of a line that is smoothed
  corners?: number[];
  run?: string | null;
  numbers?: (number | null)[];
}

export interface Label {
  x: Num;
  y: Num;
  text: string;
  colour: ColourName;
  rank: number;
  owner: string;
  run?: string | null;
  number?: number | null;
}

export interface Panel {
  title: string;
  x: Axis;
  y: Axis;
  rows?: number;
  marks: Num[];
  marks_title: string;
  notes: string[];
  series: Series[];
  labels: Label[];
}

export interface Figure {
  title: string;
  columns: number;
  symbols: string[];
  panels: Panel[];
}

export interface Table {
  title?: string;
  columns: { name: string; unit: string }[];
  rows: (Num | string)[][];
}

export interface FigureAnswer {
  figure: Figure;
  table: Table | null;
}

export interface SpecialPoints {
  columns: Quantity[];
  rows: SpecialPoint[];
}

export interface SpecialPoint {
  number: number;
  label: string;
  name: string;
  type: string;
  type_words: string;
  detail: string;
  stable: boolean | null;
  unphysical: boolean | null;
  coordinates: Num[];
}

export interface NamedNumber {
  name: string;
  value: Num;
  unit: string;
  words: string;
}

export interface Action {
  name: string;
  title: string;
  words: string;
  along: number; // parameters that it takes
  parameters?: { name: string; least: number; greatest: number }[]; // that are proposed
}

export interface Point {
  run: string;
  number: number;
  label: string;
  name: string;
  title: string;
  kind: "orbit" | "motion" | "record";
  type: string;
  type_words: string;
  detail: string;
  stable: boolean | null;
  unphysical: boolean | null;
  period: Num;
  error: Num;
  coordinates: NamedNumber[];
  parameters: NamedNumber[];
  values: NamedNumber[];
  multipliers: [Num, Num][];
  half_multipliers: [Num, Num][];
  eigenvalues: [Num, Num][]; // of equilibria, per unit of time
  signature: string | null;
  tables: Table[];
  facts: [string, string | number][];
  actions: Action[];
}

export interface MotionColumn {
  name: string;
  unit: string;
  words?: string;
  period?: Num; // of a cyclic value
}

export interface Motion {
  columns: MotionColumn[];
  values: Num[][]; // column by column; the first is the time
  begins: number[]; // rows at which arcs begin
  contacts: number[];
  modes?: string[]; // of each arc
  complete: boolean;
  ending: string;
  detail?: string;
  at_rest?: boolean; // of an equilibrium, which has one row
  limit?: string; // of the work for a simulation that it has reached
}

export type Pair = [string | number, string | number];

/** A shape of a drawing. Its numbers are expressions in the states and parameters of the model. */
export interface DrawnShape {
  kind: "line" | "arrow" | "spring" | "wall" | "path" | "box" | "circle" | "text";
  points?: Pair[];
  from?: Pair;
  to?: Pair;
  at?: Pair;
  size?: Pair;
  radius?: string | number;
  text?: string;
  colour?: string;
  modes?: string[];
}

export interface Drawing {
  text?: string;
  x: [number, number];
  y: [number, number];
  shapes: DrawnShape[];
}

export interface ModelParameter extends Quantity {
  value: Num;
  text?: string;
  dependent?: boolean; // computed from others
}

export interface ModelState extends Quantity {
  initial: Num;
  cyclic: boolean;
  period?: Num; // of a cyclic state
  drifting: boolean;
  text?: string;
}

export interface Model {
  name: string;
  text: string;
  file?: string; // of the opened model, in which it can be saved
  revision?: number; // of the text of that file
  parameters: ModelParameter[];
  states: ModelState[];
  quantities?: Quantity[];
  drawing: Drawing | null;
  actions?: Action[]; // of the opened model: what can be done from its initial state
  time_unit?: string;
  initial_mode?: string;
  duration?: Num; // for which a motion is usually shown
  histories?: string[]; // that are usually shown
  portrait?: string[];
}

export interface SimulationWish {
  run: string | null;
  text: string | null;
  parameters: Record<string, number>;
  initial: Record<string, number>;
  mode: string; // in which it begins; empty: that of the model
  duration: number | null;
  names: string[];
}

export interface Mistake {
  problem: string;
  remedy: string;
  line: number;
  column: number;
}

export interface StudyText {
  text: string;
  name: string; // of its file, or one that it could have
  revision: number;
  saved: boolean;
  has_file: boolean; // false: it was never saved, and needs a name
  errors?: Mistake[];
}

export interface ModelText {
  text: string;
  file: string;
  revision: number;
}

export interface StudySaving {
  save: boolean;
  file?: string; // name of a new file
  replace?: boolean; // of what another program has written
}

export interface ProposalWish {
  run: string | null; // null: from the initial state of the opened model
  number: number | null;
  action: string;
  along: Record<string, [number, number]> | string[];
  options: Record<string, unknown>;
}

export interface Proposal {
  name: string;
  text: string;
}

export interface Job {
  id: number | string;
  runs: string[];
  state: "waiting" | "running" | "complete" | "stopped" | "failed";
  run: string;
  done: Num; // points of the run
  points: Num; // that are planned
  message: string;
}

export interface StartedJob {
  id: number | string;
  runs: string[];
}

export interface GrazingAnswer {
  verdict: string;
  words: string;
  facts: (Num | string)[][];
}

export interface TripAnswer {
  figure: Figure | null;
  table: Table | null;
  words: string | string[];
}

export interface Check {
  errors: Mistake[];
  runs: string[];
}
