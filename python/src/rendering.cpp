#include "python/src/bindings.h"

namespace freepath::python {

void bind_rendering(nanobind::module_& /*module*/) {}

}  // namespace freepath::python
