#pragma once

namespace caustics {

/// Takes from this process, with all its threads, what decoding needs not: it can open no file, start no program or
/// process and reach no other process; such calls fail. What it has open it can still read and write, and it has memory and threads. Where
/// the kernel or the processor has no such filter (seccomp), or under sanitizers, nothing is taken.
void confine_this_process();

}  // namespace caustics
