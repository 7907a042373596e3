#pragma once
/// @file The subcommands of the program, one file each. Each function adds its subcommand, whose
/// callback does the work and throws freepath::Error (or a CLI11 error) where it can't.

#include <functional>

#include <CLI/CLI.hpp>

namespace freepath::program {

/// @param clock as of run()
void add_render_command(CLI::App& program, const std::function<double()>& clock);
void add_merge_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_generate_command(CLI::App& program);
void add_convert_command(CLI::App& program);
void add_flux_command(CLI::App& program);
void add_slab_command(CLI::App& program);
void add_diff_command(CLI::App& program);
void add_compare_command(CLI::App& program);
void add_plan_command(CLI::App& program);
void add_lab_command(CLI::App& program);
void add_trackers_command(CLI::App& program);

}  // namespace freepath::program
