#include "python/src/bindings.h"

namespace freepath::python {

void bind_scenes(nanobind::module_& /*module*/) {}

}  // namespace freepath::python
