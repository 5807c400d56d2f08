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
  SpecialPoints,
  StartedJob,
  StudyPicture,
  StudySaving,
  StudyText,
  TripAnswer,
} from "./contract.js";
import { readEvents } from "./event_reader.js";
import { Refusal, type FoundPoint, type Listener, type Source, type Workshop } from "./source.js";

const retryDelay = 1500; // milliseconds between tries to reach a server that does not answer

interface ErrorAnswer {
  problem?: string;
  remedy?: string;
  place?: { line?: number; column?: number };
}

/** The server that gave this page. */
export class LiveSource implements Source, Workshop {
  readonly workshop: Workshop = this;

  constructor(private readonly token: string) {}

  private async ask<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
    const headers: Record<string, string> = { Authorization: `Bearer ${this.token}` };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const text = body === undefined ? null : JSON.stringify(body);
    let answer: Response;
    try {
      answer = await fetch(path, { method, headers, body: text, signal: signal ?? null, cache: "no-store" });
    } catch (error) {
      if (error instanceof DOMException && error.name === "AbortError") throw error;
      throw new Refusal("the server does not answer", "start `graze view` again", 0);
    }
    const content = await answer.text();
    let data: unknown = null;
    try {
      data = content === "" ? null : JSON.parse(content);
    } catch {
      if (answer.ok) throw new Refusal("the server's answer is not JSON", "", answer.status);
    }
    if (!answer.ok) throw refusalOf(data, answer.status);
    return data as T;
  }

  private post<T>(path: string, body: unknown, signal?: AbortSignal): Promise<T> {
    return this.ask<T>("POST", path, body, signal);
  }

  session = () => this.ask<Session>("GET", "/api/session");
  runs = () => this.ask<Run[]>("GET", "/api/runs");
  pictures = () => this.ask<StudyPicture[]>("GET", "/api/pictures");

  figure(wish: PictureWish, signal?: AbortSignal): Promise<FigureAnswer> {
    const body = wish.name !== undefined && !wish.runs ? { name: wish.name } : { picture: wish };
    return this.post<FigureAnswer>("/api/figure", body, signal);
  }

  async specialPoints(run: string): Promise<SpecialPoint[]> {
    return (await this.ask<SpecialPoints>("GET", `/api/points?run=${encodeURIComponent(run)}`)).rows;
  }

  async point(run: string, number: number, signal?: AbortSignal): Promise<FoundPoint> {
    const path = `/api/point?run=${encodeURIComponent(run)}&number=${number}`;
    return { point: await this.ask<Point>("GET", path, undefined, signal), note: "" };
  }

  motion(run: string, number: number, names: string[], signal?: AbortSignal): Promise<Motion> {
    return this.post<Motion>("/api/motion", { run, number, names }, signal);
  }

  model(run: string | null): Promise<Model> {
    return this.ask<Model>("GET", run === null ? "/api/model" : `/api/model?run=${encodeURIComponent(run)}`);
  }

  simulate = (wish: SimulationWish, signal?: AbortSignal) => this.post<Motion>("/api/simulate", wish, signal);
  check = (kind: "model" | "study", text: string) => this.post<Check>("/api/check", { kind, text });
  schema = () => this.ask<unknown>("GET", "/api/schema");
  words = () => this.ask<unknown>("GET", "/api/words");
  study = () => this.ask<StudyText>("GET", "/api/study");
  modelOf = (text: string) => this.post<Model>("/api/model", { text });
  keepModel = (text: string, revision: number, replace: boolean) =>
    this.ask<ModelText>("PUT", "/api/model", { text, revision, replace });
  remove = (run: string) => this.ask<unknown>("DELETE", `/api/runs/${encodeURIComponent(run)}`);
  keepStudy = (text: string, revision: number, saving: StudySaving) =>
    this.ask<StudyText>("PUT", "/api/study", { text, revision, ...saving });
  propose = (wish: ProposalWish) => this.post<Proposal>("/api/propose", wish);
  start = (work: { text: string } | { runs: string[] }) => this.post<StartedJob>("/api/jobs", work);
  jobs = () => this.ask<Job[]>("GET", "/api/jobs");
  stop = (id: number | string) => this.ask<void>("DELETE", `/api/jobs/${encodeURIComponent(String(id))}`);
  grazing = (run: string, number: number) => this.post<GrazingAnswer>("/api/grazing", { run, number });
  trip = (run: string, number: number, options: Record<string, unknown>) =>
    this.post<TripAnswer>("/api/trip", { run, number, options });

  listen(listener: Listener): void {
    void this.keepListening(listener);
  }

  private async keepListening(listener: Listener): Promise<void> {
    for (;;) {
      try {
        const headers = { Authorization: `Bearer ${this.token}` };
        const answer = await fetch("/api/events", { headers, cache: "no-store" });
        if (answer.status === 401 || answer.status === 403) {
          listener.connection("refused"); // another server has this port now: its token is another one
          return;
        }
        if (!answer.ok || !answer.body) throw new Refusal("no events", "", answer.status);
        listener.connection("open");
        let ended = false;
        await readEvents(answer.body, (event, data) => {
          if (event === "runs") listener.runs((data as { runs: never[] }).runs);
          else if (event === "job") listener.job(data as Job);
          else if (event === "study") listener.study((data as { revision: number }).revision);
          else if (event === "end") ended = true;
        });
        listener.connection(ended ? "ended" : "lost");
      } catch {
        listener.connection("lost");
      }
      await new Promise((done) => setTimeout(done, retryDelay));
    }
  }
}

function refusalOf(data: unknown, status: number): Refusal {
  const given = data as { error?: ErrorAnswer; errors?: ErrorAnswer[] } | null;
  const first = given?.error ?? given?.errors?.[0];
  if (!first?.problem) return new Refusal(`the server refuses (${status})`, "", status);
  return new Refusal(first.problem, first.remedy ?? "", status, first.place?.line ?? 0, first.place?.column ?? 0);
}
