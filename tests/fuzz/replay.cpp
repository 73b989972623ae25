#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// A target of libFuzzer without libFuzzer, which compilers other than clang++ have not:
//
//   replay_NAME FOLDER...                        each file of the folders
//   replay_NAME --mutate SECONDS SEED FOLDER...  changes of them, blindly; seconds of the processors' time
//
// An input that ends the process, or takes 10 s of its processors' time, is left in ./input.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data,
                                                                     std::size_t size,
                                                                     std::size_t most,
                                                                     unsigned seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

namespace fs = std::filesystem;

std::mt19937 chance;

std::size_t below(std::size_t count) { return chance() % count; }

/// What readers of numbers, lines and words may stumble over.
const std::vector<std::string> awkward = {
    "nan",  "-1",     "1e999", "1e19", "4294967296", "18446744073709551616",
    "0x10", "1e-320", "-0",    "\n",   "\r\n",       "\"",
    "=",    "/",      "--",    "../",  "\xff",       "[",
    "{}",   "%s",     "$(x)",  ","};

std::string changed(std::string bytes) {
    const std::size_t at = below(bytes.size() + 1);
    switch (below(5)) {
        case 0: return bytes.insert(at, awkward[below(awkward.size())]);
        case 1: return bytes.insert(at, bytes.substr(below(bytes.size() + 1), 1 + below(40)));
        case 2: return bytes.replace(at, 1 + below(6), awkward[below(awkward.size())]);
        case 3: return bytes.erase(at, 1 + below(8));
        default: break;
    }
    if (at < bytes.size()) bytes[at] = static_cast<char>(chance());
    return bytes;
}

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> files_of(const std::vector<std::string>& folders) {
    std::vector<fs::path> files;
    for (const std::string& folder : folders)
        for (const auto& entry : fs::directory_iterator(folder))
            files.push_back(fs::absolute(entry.path()));
    std::ranges::sort(files);
    return files;
}

void read(const std::string& bytes) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

void replay(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) {
        // The last line names the input, should it end the process.
        std::printf("%s\n", file.c_str());
        std::fflush(stdout);
        read(content(file));
    }
    std::printf("%zu inputs\n", files.size());
}

std::string input_file;
/// The input at work.
const char* at_work = nullptr;
std::size_t size_at_work = 0;

extern "C" void keep_input(int number) {
    const int out = open(input_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out >= 0 && write(out, at_work, size_at_work) >= 0) close(out);
    std::signal(number, SIG_DFL);
    raise(number);
}

/// Keeps the input whatever ends the process, an endless recursion as well.
void keep_what_ends_this() {
    static std::array<char, 1 << 16> stack;
    const stack_t other{stack.data(), 0, stack.size()};
    sigaltstack(&other, nullptr);
    input_file = fs::absolute("input").string();
    struct sigaction action = {};
    action.sa_handler = keep_input;
    action.sa_flags = SA_ONSTACK;
    for (const int number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGTERM})
        sigaction(number, &action, nullptr);
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void mutate(const std::vector<fs::path>& files, double seconds) {
    constexpr std::size_t most = 20'000;
    constexpr itimerval longest = {{0, 0}, {10, 0}};
    std::vector<std::string> inputs;
    for (const fs::path& file : files) inputs.push_back(content(file));
    keep_what_ends_this();
    std::size_t executions = 0;
    std::string bytes;
    for (; executions % 16 != 0 || processor_seconds() < seconds; ++executions) {
        bytes = inputs[below(inputs.size())];
        std::size_t size = std::min(bytes.size(), most);
        bytes.resize(most);
        auto* const data = reinterpret_cast<std::uint8_t*>(bytes.data());
        for (std::size_t changes = 1 + below(4); changes > 0; --changes)
            size = LLVMFuzzerCustomMutator != nullptr
                       ? LLVMFuzzerCustomMutator(data, size, most, static_cast<unsigned>(chance()))
                       : LLVMFuzzerMutate(data, size, most);
        bytes.resize(size);
        at_work = bytes.data();
        size_at_work = size;
        setitimer(ITIMER_PROF, &longest, nullptr);
        read(bytes);
    }
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::printf("%zu executions, %.1f s of processors' time, %ld MB at most\n", executions,
                processor_seconds(), used.ru_maxrss / 1024);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) bytes = changed(bytes);
    bytes.resize(std::min(bytes.size(), most));
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}

int main(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    const bool mutates = words.size() > 3 && words[0] == "--mutate";
    const double seconds = mutates ? std::stod(words[1]) : 0;
    if (mutates) {
        chance.seed(static_cast<unsigned>(std::stoul(words[2])));
        words.erase(words.begin(), words.begin() + 3);
    }
    const std::vector<fs::path> files = files_of(words);
    if (files.empty()) return 1;
    if (LLVMFuzzerInitialize != nullptr) LLVMFuzzerInitialize(&argc, &argv);
    if (mutates)
        mutate(files, seconds);
    else
        replay(files);
}
