import type {
  Figure,
  FigureAnswer,
  Model,
  Motion,
  PictureWish,
  Point,
  Run,
  Session,
  SpecialPoint,
  StudyPicture,
} from "./contract.js";
import { mergedFigure } from "./merged_figure.js";
import { Refusal, type FoundPoint, type Source } from "./source.js";

/** What an exported file holds. */
export interface StoredPage {
  session: Session;
  runs: Run[];
  pictures: StudyPicture[];
  figures: { key: PictureWish | string; answer: FigureAnswer }[];
  special_points?: Record<string, SpecialPoint[]>;
  points: Record<string, Point>;
  motions: Record<string, Motion>;
  models: Record<string, Model>;
}

/** The data inside of the file that is open. Nothing can be computed. */
export class StoredSource implements Source {
  readonly workshop = null;

  constructor(private readonly page: StoredPage) {}

  session = async () => this.page.session;
  runs = async () => this.page.runs;
  pictures = async () => this.page.pictures;

  /** The figure that was asked for when the file was made, or else one made of those of the runs. */
  async figure(wish: PictureWish): Promise<FigureAnswer> {
    const exact = this.stored(wish);
    if (exact) return exact;
    const runs = wish.runs ?? [];
    const parts = runs.map((run) => ({ run, figure: this.stored({ runs: [run] })?.figure }));
    const known = parts.filter((part): part is { run: string; figure: Figure } => part.figure !== undefined);
    const isPlain = Object.keys(wish).every((key) => key === "runs" || wish[key as keyof PictureWish] === undefined);
    const figure = isPlain && runs.length > 0 && known.length === runs.length ? mergedFigure(known) : null;
    if (figure) return { figure, table: null };
    throw new Refusal("this file has no such picture", "open the results with `graze view` to draw it", 404);
  }

  private stored(wish: PictureWish): FigureAnswer | undefined {
    const wanted = keyOf(wish);
    return this.page.figures.find(({ key }) => keyOf(key) === wanted)?.answer;
  }

  async specialPoints(run: string): Promise<SpecialPoint[]> {
    const known = this.page.special_points?.[run];
    if (known) return known;
    return Object.values(this.page.points)
      .filter((point) => point.run === run && point.label !== "")
      .map((point) => ({ ...point, coordinates: point.coordinates.map((one) => one.value) }));
  }

  async point(run: string, number: number): Promise<FoundPoint> {
    const exact = this.page.points[`${run}/${number}`];
    if (exact) return { point: exact, note: "" };
    const near = this.nearest(this.page.points, run, number);
    if (near === null)
      throw new Refusal("this file holds no orbit of that run", "open the results with `graze view` to see it", 404);
    const point = this.page.points[`${run}/${near}`];
    return { point, note: `The file holds no orbit of point ${number}; this is the nearest one that it holds.` };
  }

  async motion(run: string, number: number): Promise<Motion> {
    const near = this.nearest(this.page.motions, run, number);
    if (near === null)
      throw new Refusal("this file holds no motion of that point", "open the results with `graze view` to see it", 404);
    return this.page.motions[`${run}/${near}`];
  }

  async model(run: string | null): Promise<Model> {
    const model = run === null ? Object.values(this.page.models)[0] : this.page.models[run];
    if (!model) throw new Refusal("this file does not hold the model", "", 404);
    return model;
  }

  private nearest(stored: Record<string, unknown>, run: string, number: number): number | null {
    let best: number | null = null;
    for (const key of Object.keys(stored)) {
      const slash = key.lastIndexOf("/");
      if (key.slice(0, slash) !== run) continue;
      const candidate = Number(key.slice(slash + 1));
      if (best === null || Math.abs(candidate - number) < Math.abs(best - number)) best = candidate;
    }
    return best;
  }
}

/** A text that is the same for wishes that ask for the same picture, in whatever order their keys are. */
function keyOf(wish: PictureWish | string): string {
  if (typeof wish === "string") return wish;
  if (wish.name !== undefined && !wish.runs) return wish.name;
  const entries = Object.entries(wish).filter(([name, value]) => name !== "name" && value !== undefined);
  return JSON.stringify(entries.sort(([a], [b]) => (a < b ? -1 : 1)));
}
