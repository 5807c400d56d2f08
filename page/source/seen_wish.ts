import type { PictureWish, StudyPicture } from "./contract.js";
import type { FigureView } from "./figure_view.js";

/** What a picture of the study shows, without what it leaves to be chosen. */
export function namedWish(picture: StudyPicture | undefined): PictureWish {
  if (!picture) return {};
  const { title, kind, runs, over, x, y, samples, directions, points } = picture;
  const given = Object.entries({ title, kind, runs, over, x, y, samples, directions, points });
  return Object.fromEntries(given.filter(([, value]) => value && value.length > 0)) as PictureWish;
}

/** What asks for the picture as it is seen, with its zoom. */
export function seenWish(view: FigureView): PictureWish {
  const wish: PictureWish = { ...namedWish(view.picture), ...view.pictureWish, runs: view.runs };
  delete wish.name;
  const [first] = view.diagrams;
  if (!first) return wish;
  const axes = (["x", "y"] as const).filter((_, index) => view.diagrams.some((one) => one.logarithmic[index]));
  if (axes.length > 0) wish.logarithmic = [...axes];
  if (!first.showsAll) {
    const { x, y } = first.currentView;
    wish.x_range = [x.low, x.high];
    if (view.diagrams.length === 1) wish.y_range = [y.low, y.high];
  }
  return wish;
}
