#include "shrink.h"

#include <algorithm>
#include <cmath>

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

/// Takes the place of `case_` whatever still fails.
class Shrinker {
 public:
  Shrinker(Case failing, const Fails& fails, std::size_t questions)
      : case_(std::move(failing)), fails_(fails), left_(questions) {}

  Case run() {
    bool again = true;
    while (again && left_ > 0) {
      again = remove_commands();
      again |= remove_triangles();
      for (std::size_t i = 0; i < case_.commands.size(); ++i) again |= simplify_command(i);
    }
    return case_;
  }

 private:
  bool accept(const Case& smaller) {
    if (left_ == 0) return false;
    --left_;
    if (!fails_(smaller)) return false;
    case_ = smaller;
    return true;
  }

  /// Leaves out runs of a list's elements, long runs first. `list` finds the list in a case.
  template <class List>
  bool remove_runs(const List& list) {
    bool changed = false;
    for (std::size_t run = list(case_).size(); run > 0; run /= 2) {
      for (std::size_t first = 0; first < list(case_).size();) {
        Case smaller = case_;
        auto& elements = list(smaller);
        const std::size_t end = std::min(first + run, elements.size());
        elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(first),
                       elements.begin() + static_cast<std::ptrdiff_t>(end));
        if (accept(smaller))
          changed = true;
        else
          first += run;
      }
    }
    return changed;
  }

  bool remove_commands() {
    return remove_runs([](Case& c) -> std::vector<CaseCommand>& { return c.commands; });
  }

  bool remove_triangles() {
    bool changed = false;
    for (std::size_t i = 0; i < case_.commands.size(); ++i)
      if (std::holds_alternative<CaseDraw>(case_.commands[i]))
        changed |= remove_runs([i](Case& c) -> std::vector<Triangle>& {
          return std::get<CaseDraw>(c.commands[i]).triangles;
        });
    return changed;
  }

  /// Sets one value of command i to a simpler one, if it is not so already.
  template <class Command, class Member, class Value>
  bool set(std::size_t i, const Member& member, const Value& simpler) {
    Case smaller = case_;
    auto& value = member(std::get<Command>(smaller.commands[i]));
    if (value == simpler) return false;
    value = simpler;
    return accept(smaller);
  }

  bool simplify_command(std::size_t i) {
    return std::holds_alternative<Clear>(case_.commands[i]) ? simplify_clear(i) : simplify_draw(i);
  }

  bool simplify_clear(std::size_t i) {
    const auto set_clear = [&](const auto& member, const auto& simpler) {
      return set<Clear>(i, member, simpler);
    };
    const Clear plain;
    bool changed = set_clear(
        [](Clear & c) -> auto& { return c.color; }, plain.color);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.depth; }, plain.depth);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.stencil; }, plain.stencil);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.scissor; }, plain.scissor);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.color_write; }, plain.color_write);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.depth_write; }, plain.depth_write);
    changed |= set_clear(
        [](Clear & c) -> auto& { return c.stencil_write_mask; }, plain.stencil_write_mask);
    return changed;
  }

  bool simplify_draw(std::size_t i) {
    const auto set_draw = [&](const auto& member, const auto& simpler) {
      return set<CaseDraw>(i, member, simpler);
    };
    const CaseDraw plain;
    bool changed = set_draw(
        [](CaseDraw & d) -> auto& { return d.state; }, plain.state);
    changed |= set_draw(
        [](CaseDraw & d) -> auto& { return d.lookup; }, plain.lookup);
    changed |= set_draw(
        [](CaseDraw & d) -> auto& { return d.stencil_ref; }, plain.stencil_ref);
    changed |= set_draw(
        [](CaseDraw & d) -> auto& { return d.color; }, plain.color);
    changed |= simplify_state(i);
    changed |= simplify_faces(i);
    return round_vertices(i) || changed;
  }

  bool simplify_state(std::size_t i) {
    const auto set_state = [&](const auto& member, const auto& simpler) {
      return set<CaseDraw>(
          i, [&](CaseDraw & d) -> auto& { return member(d.state); }, simpler);
    };
    const State plain;
    bool changed = set_state(
        [](State & s) -> auto& { return s.depth; }, plain.depth);
    changed |= set_state(
        [](State & s) -> auto& { return s.stencil; }, plain.stencil);
    changed |= set_state(
        [](State & s) -> auto& { return s.color.write; }, plain.color.write);
    changed |= set_state(
        [](State & s) -> auto& { return s.color.blend; }, plain.color.blend);
    changed |= set_state(
        [](State & s) -> auto& { return s.cull; }, plain.cull);
    changed |= set_state(
        [](State & s) -> auto& { return s.front_face; }, plain.front_face);
    changed |= set_state(
        [](State & s) -> auto& { return s.polygon_offset; }, plain.polygon_offset);
    changed |= set_state(
        [](State & s) -> auto& { return s.scissor; }, plain.scissor);
    changed |= set_state(
        [](State & s) -> auto& { return s.viewport; }, plain.viewport);
    changed |= set_state(
        [](State & s) -> auto& { return s.depth_range; }, plain.depth_range);
    changed |= set_state(
        [](State & s) -> auto& { return s.depth_clamp; }, plain.depth_clamp);
    return changed;
  }

  bool simplify_faces(std::size_t i) {
    bool changed = false;
    for (const auto face : {&StencilState::front, &StencilState::back}) {
      const auto set_face = [&](auto member, auto simpler) {
        if (!std::get<CaseDraw>(case_.commands[i]).state.stencil) return false;
        return set<CaseDraw>(
            i, [&](CaseDraw & d) -> auto& { return ((*d.state.stencil).*face).*member; }, simpler);
      };
      const StencilFace plain;
      changed |= set_face(&StencilFace::func, plain.func);
      changed |= set_face(&StencilFace::read_mask, plain.read_mask);
      changed |= set_face(&StencilFace::write_mask, plain.write_mask);
      changed |= set_face(&StencilFace::fail, plain.fail);
      changed |= set_face(&StencilFace::depth_fail, plain.depth_fail);
      changed |= set_face(&StencilFace::pass, plain.pass);
    }
    return changed;
  }

  /// w to 1, then every clip coordinate to 0 or to a multiple of 2^-bits, the coarsest that will
  /// do.
  bool round_vertices(std::size_t i) {
    bool changed = false;
    const std::size_t count = std::get<CaseDraw>(case_.commands[i]).triangles.size();
    for (std::size_t t = 0; t < count; ++t)
      for (std::size_t v = 0; v < 3; ++v) changed |= round_vertex(i, t, v);
    return changed;
  }

  bool round_vertex(std::size_t i, std::size_t t, std::size_t v) {
    const auto set_vertex = [&](const glm::vec4& simpler) {
      return set<CaseDraw>(
          i, [&](CaseDraw & d) -> auto& { return d.triangles[t][v]; }, simpler);
    };
    const auto now = [&] { return std::get<CaseDraw>(case_.commands[i]).triangles[t][v]; };
    bool changed = false;
    if (now().w > 0.0f && now().w != 1.0f) changed = set_vertex(now() / now().w);
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec4 zero = now();
      zero[axis] = 0.0f;
      if (now()[axis] != 0.0f && set_vertex(zero)) {
        changed = true;
        continue;
      }
      for (int bits = 0; bits <= 12; ++bits) {
        const float scale = std::ldexp(1.0f, bits);
        glm::vec4 p = now();
        p[axis] = std::round(p[axis] * scale) / scale;
        if (p[axis] == now()[axis]) break;
        if (set_vertex(p)) {
          changed = true;
          break;
        }
      }
    }
    return changed;
  }

  Case case_;
  const Fails& fails_;
  std::size_t left_;
};

}  // namespace

Case shrink(Case failing, const Fails& fails, std::size_t questions) {
  return Shrinker(std::move(failing), fails, questions).run();
}

}  // namespace gnomon::peer
