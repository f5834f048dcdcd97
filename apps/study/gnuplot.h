// Diagrams by the program gnuplot (Debian: gnuplot-nox).
#pragma once

#include <filesystem>
#include <string>

namespace gnomon::apps::study {

/// Throws ar::InputError that says what is missing.
void require_gnuplot();

/// Runs a script whose picture, in a format that its extension names (svg), goes to `file`; written
/// beside, then renamed. The script sets neither terminal nor output; `width` and `height` in
/// points. Throws ar::InputError if it fails.
void plot(const std::filesystem::path& file, int width, int height, const std::string& script);

/// A text in gnuplot's quotes, without its markup.
std::string gnuplot_quoted(const std::string& text);

}  // namespace gnomon::apps::study
