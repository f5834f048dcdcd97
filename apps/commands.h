// The program's subcommands: one file and one function each. A command adds itself with its options
// and a callback; the callback does the work and throws what goes wrong (apps/main.cpp says it).
#pragma once

namespace CLI {
class App;
}

namespace gnomon::apps {

/// gnomon ar SCENE: virtual objects and their shadows in a photograph or a video.
void add_ar(CLI::App& program);

/// gnomon capture FOLDER: the light of a real scene from photographs.
void add_capture(CLI::App& program);

/// gnomon chart: time against error, every method and setting.
void add_chart(CLI::App& program);

/// gnomon compare A B: how much two pictures differ.
void add_compare(CLI::App& program);

/// gnomon fit SCENE: the least that a scene needs within an error.
void add_fit(CLI::App& program);

/// gnomon golden --verify: do the golden frames have their bytes on this machine?
void add_golden(CLI::App& program);

/// gnomon history FRAME X Y: what happened at a pixel.
void add_history(CLI::App& program);

/// gnomon inspect SCENE|FRAME: a page that shows every buffer and every fragment.
void add_inspect(CLI::App& program);

/// gnomon lab: the rasterizer as a page to play with, and its states as pictures.
void add_lab(CLI::App& program);

/// gnomon mesh COMMAND: is a mesh fit for shadow volumes?
void add_mesh(CLI::App& program);

/// gnomon render SCENE: a wholly virtual scene with its shadows.
void add_render(CLI::App& program);

/// gnomon replay FRAME: a recorded frame executed anew.
void add_replay(CLI::App& program);

/// gnomon stability: where methods fail.
void add_stability(CLI::App& program);

}  // namespace gnomon::apps
