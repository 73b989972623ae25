#pragma once

namespace caustics::experiments {

/// From now on SIGINT, SIGTERM or, where it is not ignored (nohup), SIGHUP only asks the program to stop (request_interrupt); another, a second
/// later, ends it.
void catch_interrupts();

/// From now on the first such signal ends this process, but none that it forks, within a second: with one line and exit
/// code 130, wherever it is, if it has not ended by itself by then. Libraries look at no signal of ours for longer. For work
/// whose files are whole or absent wherever it ends; where a file system knows no files without a name, one that was being
/// written stays under its temporary name.
void end_soon_after_interrupts();
/// No longer: the process says itself how it ends.
void end_in_own_time();

}  // namespace caustics::experiments
