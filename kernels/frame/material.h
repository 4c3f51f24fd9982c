// Materials by the ids of pixels.
#include "base/vector.h"
#include "params.h"

// 1 + the index of the material with that id, or 0.
static inline vint find_material(vfloat id, global const struct MaterialParams* materials) {
  const vfloat whole = rint(id);
  const vint is_whole = AS_MASK(fabs(id - whole) <= 1e-3f);
  vint found = (vint)(0);
  for (int m = MATERIALS - 1; m >= 0; --m) {
    found = select(found, (vint)(m + 1), is_whole & AS_MASK(whole == (float)materials[m].id));
  }
  return found;
}
