#include "apps/variant.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::apps {

void add_variant(CLI::App& command, VariantArguments& arguments) {
  command.add_option(
      "--isa", arguments.isa,
      "Instruction set of the kernels: best, scalar, or another that the machine has");
  command.add_option("--threads", arguments.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
}

raster::ExecuteOptions execute_options(const VariantArguments& arguments) {
  const auto available = raster::available_isas();
  const std::optional<raster::Isa> isa = raster::isa_named(arguments.isa);
  if (isa && (*isa == raster::Isa::best || std::ranges::count(available, *isa) > 0))
    return {.threads = arguments.threads, .isa = *isa};
  std::string names = "best";
  for (const raster::Isa known : available) names += ", " + std::string(raster::name(known));
  throw ar::InputError("--isa: " +
                       (isa ? "this machine or build has no " + arguments.isa
                            : "there is no '" + ar::one_line(arguments.isa) + "'") +
                       "; it can be " + names);
}

}  // namespace gnomon::apps
