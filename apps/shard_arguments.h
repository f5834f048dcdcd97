// Which part of a run a command was asked for.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace gnomon::apps {

struct ShardArguments {
  /// study::parse_shard reads it.
  std::string shard = "1/1";
  bool merge = false;
  int threads = 0;
};

/// Adds --shard, --merge and --threads.
void add_shard(CLI::App& command, ShardArguments& arguments);

}  // namespace gnomon::apps
