#pragma once

namespace caustics::experiments {

/// From now on SIGINT or SIGTERM only asks the program to stop (request_interrupt); another, a second
/// later, ends it.
void catch_interrupts();

}  // namespace caustics::experiments
