// Which instruction set and how many threads a command was asked for.
#pragma once

#include <string>

#include "raster/execute.h"

namespace CLI {
class App;
}

namespace gnomon::apps {

struct VariantArguments {
  std::string isa = "best";
  int threads = 0;
};

/// Adds --isa and --threads.
void add_variant(CLI::App& command, VariantArguments& arguments);

/// Throws ar::InputError, which lists the instruction sets of this machine, for any other one.
raster::ExecuteOptions execute_options(const VariantArguments& arguments);

}  // namespace gnomon::apps
