#include "bench/worker.h"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gnomon::bench {
namespace {

struct Pipe {
  int read = -1, write = -1;
};

/// Closed in every process but the one that is handed an end.
Pipe make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("there is no pipe left");
  return {ends[0], ends[1]};
}

/// The environment of a worker: Mesa's driver and its number of threads.
std::vector<std::string> environment_of(const Task& task) {
  std::vector<std::string> out;
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text = *entry;
    if (!text.starts_with("LP_NUM_THREADS=") && !text.starts_with("GALLIUM_DRIVER=")) {
      out.emplace_back(text);
    }
  }
  out.push_back("LP_NUM_THREADS=" + std::to_string(task.threads));
  if (task.system == System::llvmpipe || task.system == System::softpipe) {
    out.push_back("GALLIUM_DRIVER=" + std::string(name(task.system)));
  }
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::string read_line(std::FILE* file) {
  std::string line;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    if (c == '\n') return line;
    line.push_back(static_cast<char>(c));
  }
  throw std::runtime_error("it ended without an answer");
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    out.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

}  // namespace

Worker::Worker(const std::string& subject, Size size, std::span<const std::filesystem::path> models,
               const Task& task)
    : task_(task),
      what_(std::string(name(task.system)) + ", " + std::string(name(task.method)) + ", " +
            std::to_string(task.threads) + (task.threads == 1 ? " thread" : " threads")) {
  std::vector<std::string> words{"gnomon_bench",
                                 "worker",
                                 subject,
                                 text(size),
                                 std::string(name(task.system)),
                                 std::string(name(task.method)),
                                 std::to_string(task.threads)};
  for (const auto& model : models) {
    words.emplace_back("--mesh");
    words.push_back(model.string());
  }
  std::vector<std::string> environment = environment_of(task);
  const Pipe questions = make_pipe(), answers = make_pipe();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, questions.read, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, answers.write, STDOUT_FILENO);
  const int error = posix_spawn(&process_, "/proc/self/exe", &actions, nullptr,
                                pointers(words).data(), pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  close(questions.read);
  close(answers.write);
  to_ = fdopen(questions.write, "w");
  from_ = fdopen(answers.read, "r");
  if (error != 0) {
    std::fclose(to_);
    std::fclose(from_);
    throw std::runtime_error(what_ + ": its process cannot be started");
  }
}

Worker::~Worker() {
  std::fclose(to_);
  std::fclose(from_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
}

std::string Worker::ask(std::string_view question) {
  std::fwrite(question.data(), 1, question.size(), to_);
  std::fputc('\n', to_);
  std::fflush(to_);
  std::string answer;
  try {
    answer = read_line(from_);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(what_ + ": " + error.what());
  }
  if (answer.starts_with("error ")) throw std::runtime_error(what_ + ": " + answer.substr(6));
  return answer.size() > 3 ? answer.substr(3) : "";
}

StageTimes Worker::frame() {
  StageTimes times;
  const std::vector<std::string> words = split(ask("frame"), ' ');
  for (std::size_t i = 0; i < times.size() && i < words.size(); ++i) {
    if (words[i] != "-") times[i] = std::stod(words[i]);
  }
  return times;
}

Picture Worker::picture() {
  Picture picture(std::stoull(ask("picture")));
  if (std::fread(picture.data(), 1, picture.size(), from_) != picture.size()) {
    throw std::runtime_error(what_ + ": its picture breaks off");
  }
  return picture;
}

std::vector<std::string> Worker::hashes() { return split(ask("hashes"), ';'); }

Memory Worker::memory() {
  const std::vector<std::string> words = split(ask("memory"), ' ');
  return {std::stoull(words.at(0)), std::stoull(words.at(1))};
}

}  // namespace gnomon::bench
