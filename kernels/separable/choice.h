// How the pixels of a cell are scattered in a pass.
#include "separable/scatter.h"

static inline struct ChoiceParams choice_of(const struct FrameParams* f, const Tables* tables, int cell_x, int cell_y,
                                            int axis) {
  struct ChoiceParams choice = {.way = WAY_GENERAL};
  const struct CellPass pass = cell_pass(f, tables, cell_x, cell_y, axis);
  if (pass.shape == SHAPE_EMPTY) choice.way = WAY_EMPTY;
  if (JITTER || pass.material == 0) return choice;
  choice.material = pass.material - 1;
  global const struct MaterialParams* its = tables->materials + choice.material;
  const Step step = step_of(its, pass.footprint, pass.shape);
  if (step.rung < 0) return choice;
  choice.way = pass.shape;
  choice.shear = pass.shear;
  choice.rung = its->first_rung + step.rung;
  global const struct RungParams* rung = tables->rungs + choice.rung;
  choice.weight = pass.shape == SHAPE_FLAT ? first_flat_weight(rung, step.part) : rung->first_smooth_weight;
  return choice;
}

static inline int same_choice(global const struct ChoiceParams* a, global const struct ChoiceParams* b) {
  return a->way == b->way && a->material == b->material && a->rung == b->rung && a->weight == b->weight;
}
