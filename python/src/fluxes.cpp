#include "python/src/bindings.h"

namespace freepath::python {

void bind_fluxes(nanobind::module_& /*module*/) {}

}  // namespace freepath::python
