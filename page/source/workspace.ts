import type { Job, Run, Session, SpecialPoint, StudyPicture } from "./contract.js";
import type { Source } from "./source.js";

export interface Selection {
  run: string;
  number: number;
}

interface Happenings {
  selection: (selection: Selection | null) => void;
  enter: () => void; // the keyboard goes to the chosen point
  runs: (changed: Set<string>) => void; // lists have changed, and the rows of these runs
  special: (run: string) => void; // the special points of a run are known
  jobs: (jobs: Job[]) => void;
  announce: (text: string) => void; // for those who listen to the page
}

/** Whether a run finds orbits or equilibria by themselves, which follow no parameter. */
export function standsAlone(run: Run | null | undefined): boolean {
  return run?.kind === "orbit" || run?.kind === "equilibrium";
}

/** What varies along a run. Orbits have all their parameters as coordinates, the ones that vary first. */
export function varied(run: Run): string[] {
  const count = standsAlone(run) ? 0 : run.kind === "curve" ? 2 : run.is_branch ? 1 : run.coordinates.length;
  return run.coordinates.slice(0, count).map(({ name }) => name);
}

/** What all parts of the page share: runs, pictures, jobs, the chosen point; and who wants to know of changes. */
export class Workspace {
  runs: Run[] = [];
  pictures: StudyPicture[] = [];
  jobs: Job[] = [];
  selection: Selection | null = null;
  private readonly special = new Map<string, { revision: number | string; points: Map<number, SpecialPoint> }>();
  private readonly asked = new Set<string>();
  private readonly listeners: { [K in keyof Happenings]: Set<Happenings[K]> } = {
    selection: new Set(),
    enter: new Set(),
    runs: new Set(),
    special: new Set(),
    jobs: new Set(),
    announce: new Set(),
  };

  constructor(
    readonly source: Source,
    public session: Session,
  ) {}

  on<K extends keyof Happenings>(what: K, act: Happenings[K]): () => void {
    this.listeners[what].add(act);
    return () => void this.listeners[what].delete(act);
  }

  select(selection: Selection | null): void {
    const same = this.selection?.run === selection?.run && this.selection?.number === selection?.number;
    this.selection = selection;
    if (!same) for (const act of this.listeners.selection) act(selection);
  }

  enter(): void {
    for (const act of this.listeners.enter) act();
  }

  announce(text: string): void {
    for (const act of this.listeners.announce) act(text);
  }

  run(name: string): Run | undefined {
    return this.runs.find((run) => run.name === name);
  }

  /** Those that there are. */
  runsOf(names: string[]): Run[] {
    return names.map((name) => this.run(name)).filter((run): run is Run => run !== undefined);
  }

  /** The picture of the study that has this name. */
  picture(name: string | undefined): StudyPicture | undefined {
    return this.pictures.find((picture) => picture.name === name);
  }

  /** Reads the lists again. */
  async refresh(): Promise<void> {
    const before = new Map(this.runs.map((run) => [run.name, run.revision]));
    const [runs, pictures] = await Promise.all([this.source.runs(), this.source.pictures()]);
    this.runs = runs;
    this.pictures = pictures;
    const changed = new Set(runs.filter((run) => before.get(run.name) !== run.revision).map((run) => run.name));
    for (const act of this.listeners.runs) act(changed);
  }

  setJobs(jobs: Job[]): void {
    this.jobs = jobs;
    for (const act of this.listeners.jobs) act(jobs);
  }

  /** The type of a stored special point, such as "GR"; empty for others, and as long as they are not known. */
  typeOf = (run: string | null | undefined, number: number | null | undefined): string => {
    if (run === null || run === undefined || number === null || number === undefined) return "";
    const known = this.special.get(run);
    const current = this.run(run);
    if (!current?.is_branch) return "";
    if (known?.revision !== current.revision) void this.loadSpecialPoints(run, current.revision);
    const type = known?.points.get(number)?.type ?? "";
    return type === "RG" ? "" : type;
  };

  specialPointsOf(run: string): SpecialPoint[] {
    return [...(this.special.get(run)?.points.values() ?? [])];
  }

  private async loadSpecialPoints(run: string, revision: number | string): Promise<void> {
    const key = `${run}\n${revision}`;
    if (this.asked.has(key)) return;
    this.asked.add(key);
    try {
      const points = await this.source.specialPoints(run);
      this.special.set(run, { revision, points: new Map(points.map((point) => [point.number, point])) });
      for (const act of this.listeners.special) act(run);
    } catch {
      return; // without them, symbols are those of printed pictures
    }
  }
}
