// Makes the golden frames, hashes and pictures anew. Only the reference renderer writes the hashes.
#pragma once

namespace gnomon::golden {

/// Renders every scene with the reference on the calling thread and writes golden/. Prints what
/// changed. Returns the exit status, which is never 0: a run that writes the oracle has shown
/// nothing.
int bless();

}  // namespace gnomon::golden
