/** What kinds of special points are, for lists that have no points yet; src/branch/point_kind.cpp has the same names. */
const words: Record<string, string> = {
  SN: "fold",
  PD: "flip",
  NS: "torus",
  BP: "branch point",
  SB: "loss of symmetry",
  GR: "grazing",
  DZ: "vanishing segment",
  EE: "two events at once",
  GU: "guard",
  CP: "cusp",
  GF: "generalised flip",
  GT: "generalised torus",
  R1: "1:1 resonance",
  R2: "1:2 resonance",
  R3: "1:3 resonance",
  R4: "1:4 resonance",
  VS: "vanishing sensitivity",
  DF: "fold-degenerate grazing",
  DP: "flip-degenerate grazing",
  ZA: "zero acceleration",
  DG: "double grazing",
  FP: "fold-flip",
  FT: "fold-torus",
  PT: "flip-torus",
  CH: "onset of chatter",
  HB: "Hopf point",
  BE: "boundary equilibrium",
  BT: "Bogdanov-Takens point",
  ZH: "zero-Hopf point",
  HH: "double Hopf point",
  GH: "generalised Hopf point",
  HC: "homoclinic orbit",
  HT: "homoclinic tangency",
  PL: "phase locking",
  EX: "extremum",
  BD: "bound",
  UZ: "crossing",
  EP: "end",
};

/** What the labels of motions say that are no words of everyday. */
const labels: Record<string, string> = {
  ended: "to their ends",
  singular: "until the solution ceases (as by snap-through)",
  chattering: "until contacts accumulate",
  escaped: "until they leave the bounds",
};

export function labelInWords(label: string): string {
  return labels[label] ?? label;
}

/** "GR: grazing"; a label that is a word already is left as it is. */
export function kindInWords(kind: string): string {
  return kind in words ? `${kind}: ${words[kind]}` : kind;
}

export function counted(count: number, thing: string): string {
  return `${count} ${thing}${count === 1 ? "" : "s"}`;
}
