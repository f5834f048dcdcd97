#include "apps/study/gnuplot.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::apps::study {

void require_gnuplot() {
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0)
    throw ar::InputError("gnuplot: not found, and it draws the .svg (Debian: gnuplot-nox)");
}

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("''") : std::string(1, c < ' ' ? ' ' : c);
  return out + "'";
}

void plot(const std::filesystem::path& file, int width, int height, const std::string& script) {
  ar::PendingFile pending(file);
  const std::string whole = fmt::format(
      "set terminal svg size {},{} noenhanced font 'sans,11' background rgb 'white'\n"
      "set output {}\n{}\n",
      width, height, gnuplot_quoted(pending.temporary().string()), script);
  // The script goes in by standard input, so no shell sees a name.
  std::FILE* const pipe = popen("gnuplot - >/dev/null 2>&1", "w");
  if (pipe == nullptr) throw ar::InputError("gnuplot: cannot be started");
  // One that ends early is seen by its status; the signal would end this program.
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  const bool written = std::fwrite(whole.data(), 1, whole.size(), pipe) == whole.size();
  const bool drawn = pclose(pipe) == 0;
  std::signal(SIGPIPE, before);
  if (!drawn || !written)
    throw ar::InputError(ar::one_line(file.string()) + ": gnuplot could not draw it");
  pending.commit();
}

}  // namespace gnomon::apps::study
