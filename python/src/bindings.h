#pragma once
/// @file The parts of the extension _freepath, each of which adds its names to the module. The
/// package's Python files are its only users: they check and document what users give.

#include <nanobind/nanobind.h>

namespace freepath::python {

void bind_methods(nanobind::module_& module);
void bind_fields(nanobind::module_& module);
void bind_field_states(nanobind::module_& module);
void bind_media(nanobind::module_& module);
void bind_sampling(nanobind::module_& module);
void bind_scenes(nanobind::module_& module);
void bind_films(nanobind::module_& module);
void bind_pictures(nanobind::module_& module);
void bind_render_options(nanobind::module_& module);
void bind_rendering(nanobind::module_& module);
void bind_fluxes(nanobind::module_& module);
void bind_comparisons(nanobind::module_& module);
void bind_comparison_states(nanobind::module_& module);
void bind_laboratory(nanobind::module_& module);

}  // namespace freepath::python
