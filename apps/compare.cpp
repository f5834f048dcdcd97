// gnomon compare: how much two pictures differ.
#include <CLI/CLI.hpp>

#include "apps/commands.h"

namespace gnomon::apps {

void add_compare(CLI::App& program) {
  program.add_subcommand("compare", "Say how much two pictures differ");
}

}  // namespace gnomon::apps
