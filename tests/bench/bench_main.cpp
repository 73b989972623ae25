// The main program of every benchmark: Google Benchmark's, with two options of our own.
//
// Usage: bench_NAME [--isa=plain|avx2|avx512] [--quick] [--benchmark_...]
// Exit code 1 when a benchmark failed, 2 for unknown arguments.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/bench/bench.h"
#include "tests/bench/contest.h"

namespace {

/// Takes our own options out of the arguments.
caustics::bench::BenchOptions take_options(std::vector<char*>& arguments) {
    caustics::bench::BenchOptions options;
    std::erase_if(arguments, [&options](const char* argument) {
        const std::string text = argument;
        if (text == "--quick") options.quick = true;
        const bool isa = text.starts_with("--isa=");
        if (isa) options.isa = caustics::isa_from_name(text.substr(6));
        return isa || text == "--quick";
    });
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<char*> arguments(argv, argv + argc);
    try {
        const caustics::bench::BenchOptions options = take_options(arguments);
        int count = static_cast<int>(arguments.size());
        arguments.push_back(nullptr);
        benchmark::Initialize(&count, arguments.data());
        if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
        benchmark::AddCustomContext("isa", caustics::name(options.isa));
        caustics::bench::register_benchmarks(options);
    } catch (const caustics::InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return caustics::bench::any_contest_failed() ? 1 : 0;
}
