// Chooses the kernel and the weights that scatter the pixels of a block in a pass.
#include "separable/scatter.h"

static inline struct ChoiceParams choice_of(const struct FrameParams* f, const Tables* tables, int block_x, int block_y,
                                            int axis) {
  struct ChoiceParams choice = {.variant = VARIANT_GENERAL};
  const struct BlockPass pass = block_pass(f, tables, block_x, block_y, axis);
  if (pass.block_class == CLASS_EMPTY) choice.variant = VARIANT_EMPTY;
  if (JITTER || pass.material == 0) return choice;
  choice.material = pass.material - 1;
  global const struct MaterialParams* its = tables->materials + choice.material;
  const Step step = step_of(its, pass.px_per_mm, pass.block_class);
  if (step.level < 0) return choice;
  choice.variant = pass.block_class;
  choice.shear = pass.shear;
  choice.level = its->first_level + step.level;
  global const struct TapLevelParams* level = tables->levels + choice.level;
  if (pass.block_class == CLASS_FLAT) choice.weight = first_flat_weight(level, step.part);
  return choice;
}

static inline int same_choice(global const struct ChoiceParams* a, global const struct ChoiceParams* b) {
  return a->variant == b->variant && a->material == b->material && a->level == b->level && a->weight == b->weight;
}
