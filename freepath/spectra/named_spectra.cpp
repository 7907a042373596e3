#include "freepath/spectra/named_spectra.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"
#include "freepath/spectra/illuminants.h"
#include "freepath/spectra/refractive_indices.h"

namespace freepath {
namespace {

template <class Function>
LinearSpectrum every_nanometre(const Function& function) {
  return sample_spectrum(function, 360, 830, 1);
}

LinearSpectrum no_absorption() { return {{560}, {0}}; }

struct Entry {
  std::string_view name;
  LinearSpectrum (*make)();
};

constexpr auto kEntries = std::to_array<Entry>({
    // The names of flint glasses have lost their first letter in pbrt: they are SF5, SF10 and SF11.
    {"glass-BK7", [] { return every_nanometre(kGlassBk7); }},
    {"glass-BAF10", [] { return every_nanometre(kGlassBaf10); }},
    {"glass-FK51A", [] { return every_nanometre(kGlassFk51a); }},
    {"glass-LASF9", [] { return every_nanometre(kGlassLasf9); }},
    {"glass-F5", [] { return every_nanometre(kGlassSf5); }},
    {"glass-F10", [] { return every_nanometre(kGlassSf10); }},
    {"glass-F11", [] { return every_nanometre(kGlassSf11); }},
    {"metal-Ag-eta", [] { return silver_index().eta; }},
    {"metal-Ag-k", [] { return silver_index().k; }},
    {"metal-Al-eta",
     [] { return every_nanometre([](double w) { return aluminium_index(w).real(); }); }},
    {"metal-Al-k",
     [] { return every_nanometre([](double w) { return aluminium_index(w).imag(); }); }},
    {"metal-Au-eta", [] { return gold_index().eta; }},
    {"metal-Au-k", [] { return gold_index().k; }},
    {"metal-Cu-eta", [] { return copper_index().eta; }},
    {"metal-Cu-k", [] { return copper_index().k; }},
    {"metal-MgO-eta", [] { return every_nanometre(magnesium_oxide_index); }},
    {"metal-MgO-k", no_absorption},
    {"metal-TiO2-eta", [] { return every_nanometre(titanium_dioxide_index); }},
    {"metal-TiO2-k", no_absorption},
    {"stdillum-A", illuminant_a},
    {"stdillum-D50", illuminant_d50},
    {"stdillum-D65", illuminant_d65},
    {"stdillum-E", illuminant_e},
    {"stdillum-F1", [] { return illuminant_f(1); }},
    {"stdillum-F2", [] { return illuminant_f(2); }},
    {"stdillum-F3", [] { return illuminant_f(3); }},
    {"stdillum-F4", [] { return illuminant_f(4); }},
    {"stdillum-F5", [] { return illuminant_f(5); }},
    {"stdillum-F6", [] { return illuminant_f(6); }},
    {"stdillum-F7", [] { return illuminant_f(7); }},
    {"stdillum-F8", [] { return illuminant_f(8); }},
    {"stdillum-F9", [] { return illuminant_f(9); }},
    {"stdillum-F10", [] { return illuminant_f(10); }},
    {"stdillum-F11", [] { return illuminant_f(11); }},
    {"stdillum-F12", [] { return illuminant_f(12); }},
    {"illum-acesD60",
     [] {
       return daylight({0.32168, 0.33767});
     }},
});

constexpr auto kSpectrumNames = [] {
  std::array<std::string_view, kEntries.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kEntries[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> spectrum_names() { return kSpectrumNames; }

LinearSpectrum named_spectrum(std::string_view name) {
  const auto* const found = std::ranges::find(kEntries, name, &Entry::name);
  if (found != kEntries.end()) return found->make();
  const std::string_view nearest = nearest_name(name, kSpectrumNames);
  if (nearest.empty()) fail("there is no spectrum '{}'", name.substr(0, 60));
  fail("there is no spectrum '{}'; did you mean '{}'?", name.substr(0, 60), nearest);
}

}  // namespace freepath
