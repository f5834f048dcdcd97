#include "apps/shard_arguments.h"

#include <CLI/CLI.hpp>

namespace gnomon::apps {

void add_shard(CLI::App& command, ShardArguments& arguments) {
  command.add_option("--shard", arguments.shard,
                     "Run part I of N of the jobs (I/N), for a scheduler; --merge when all ran");
  command.add_flag("--merge", arguments.merge, "Put the parts that lie in the folder together");
  command.add_option("--threads", arguments.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
}

}  // namespace gnomon::apps
