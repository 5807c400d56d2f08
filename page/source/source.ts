import type {
  Check,
  FigureAnswer,
  GrazingAnswer,
  Job,
  Model,
  ModelText,
  Motion,
  PictureWish,
  Point,
  Proposal,
  ProposalWish,
  Run,
  Session,
  SimulationWish,
  SpecialPoint,
  StartedJob,
  StudyPicture,
  StudySaving,
  StudyText,
  TripAnswer,
} from "./contract.js";

/** A refusal of the server, with the remedy that it names. */
export class Refusal extends Error {
  constructor(
    readonly problem: string,
    readonly remedy: string,
    readonly status: number,
    readonly line = 0,
    readonly column = 0,
  ) {
    super(remedy ? `${problem}: ${remedy}` : problem);
  }
}

/** A point, and what its source says about it, such as that it is the nearest one that is stored. */
export interface FoundPoint {
  point: Point;
  note: string;
}

/** Where the page has its data from. Everything that only looks needs no more than this. */
export interface Source {
  session(): Promise<Session>;
  runs(): Promise<Run[]>;
  pictures(): Promise<StudyPicture[]>;
  figure(wish: PictureWish, signal?: AbortSignal): Promise<FigureAnswer>;
  specialPoints(run: string): Promise<SpecialPoint[]>;
  point(run: string, number: number, signal?: AbortSignal): Promise<FoundPoint>;
  motion(run: string, number: number, names: string[], signal?: AbortSignal): Promise<Motion>;
  model(run: string | null): Promise<Model>;
  /** Null when nothing can be computed. */
  readonly workshop: Workshop | null;
}

export interface Listener {
  runs(changes: { name: string; revision: number | string; status: Run["status"] }[]): void;
  job(job: Job): void;
  study(revision: number): void;
  connection(state: "open" | "lost" | "refused" | "ended"): void;
}

/** What only a running program can do: compute, check and keep texts. */
export interface Workshop {
  simulate(wish: SimulationWish, signal?: AbortSignal): Promise<Motion>;
  check(kind: "model" | "study", text: string): Promise<Check>;
  schema(): Promise<unknown>;
  words(): Promise<unknown>;
  study(): Promise<StudyText>;
  /** The model that a text describes. */
  modelOf(text: string): Promise<Model>;
  /** Saves a text in the file of the opened model. */
  keepModel(text: string, revision: number, replace: boolean): Promise<ModelText>;
  /** Takes a run with its points out of the results. */
  remove(run: string): Promise<unknown>;
  keepStudy(text: string, revision: number, saving: StudySaving): Promise<StudyText>;
  propose(wish: ProposalWish): Promise<Proposal>;
  start(work: { text: string } | { runs: string[] }): Promise<StartedJob>;
  jobs(): Promise<Job[]>;
  stop(id: number | string): Promise<void>;
  grazing(run: string, number: number): Promise<GrazingAnswer>;
  trip(run: string, number: number, options: Record<string, unknown>): Promise<TripAnswer>;
  listen(listener: Listener): void;
}
