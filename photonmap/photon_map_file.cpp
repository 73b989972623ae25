#include "photonmap/photon_map_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/hash.h"
#include "core/whole_file.h"

namespace caustics {

namespace {

static_assert(std::endian::native == std::endian::little, "photons are written as they lie");

constexpr std::string_view magic = "causticbench photon map\n";
constexpr std::uint32_t version = 1;
constexpr std::uint32_t longest_header = 1 << 20;

template <typename T>
std::string_view bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string_view bytes_of(std::span<const Photon> photons) {
    return {reinterpret_cast<const char*>(photons.data()), photons.size_bytes()};
}

/// The counts in the order of the file.
template <typename Counts, typename Visit>
void for_each_count(Counts& counts, const Visit& visit) {
    for (auto* count : {&counts.emitted, &counts.aimed, &counts.missed, &counts.escaped,
                        &counts.absorbed, &counts.depth_limited, &counts.stored})
        visit(*count);
}

class Reader {
public:
    explicit Reader(const std::filesystem::path& file) : file_(file), in_(file, std::ios::binary) {
        if (!in_) fail("cannot be read");
    }

    [[noreturn]] void fail(const std::string& why) const {
        throw InputError(file_.string() + ": " + why);
    }
    void read(char* to, std::size_t size) {
        in_.read(to, static_cast<std::streamsize>(size));
        if (in_.gcount() != static_cast<std::streamsize>(size))
            fail("ends too early: the photon map is cut short");
        hash_ = fnv1a({to, size}, hash_);
    }
    template <typename T>
    T read() {
        T value;
        read(reinterpret_cast<char*>(&value), sizeof(value));
        return value;
    }
    std::uint64_t hash() const { return hash_; }
    /// Bytes from here to the end.
    std::uint64_t left() {
        const auto here = in_.tellg();
        in_.seekg(0, std::ios::end);
        const auto end = in_.tellg();
        in_.seekg(here);
        return static_cast<std::uint64_t>(end - here);
    }

private:
    std::filesystem::path file_;
    std::ifstream in_;
    std::uint64_t hash_ = fnv1a("");
};

PhotonMapHeader read_header(Reader& in) {
    std::string start(magic.size(), '\0');
    if (in.left() >= magic.size()) in.read(start.data(), start.size());
    if (start != magic) in.fail("is no photon map of causticbench");
    if (const auto found = in.read<std::uint32_t>(); found != version)
        in.fail("is a photon map of version " + std::to_string(found) +
                " (known: " + std::to_string(version) + ")");
    const auto length = in.read<std::uint32_t>();
    PhotonMapHeader header;
    constexpr std::size_t numbers = 8 * sizeof(std::uint64_t) + 3 * sizeof(float);
    if (length < numbers || length > longest_header) in.fail("is damaged: its header has no sense");
    header.transport = in.read<std::uint64_t>();
    for_each_count(header.counts, [&](std::uint64_t& count) { count = in.read<std::uint64_t>(); });
    for (int c = 0; c < 3; ++c) header.flux_unit[c] = in.read<float>();
    header.origin.resize(length - numbers);
    in.read(header.origin.data(), header.origin.size());
    return header;
}

}  // namespace

void save_photon_map(const TracedPhotons& photons, std::uint64_t transport,
                     const std::string& origin, const std::filesystem::path& file) {
    WholeFile out(file);
    std::uint64_t hash = fnv1a("");
    const auto put = [&](std::string_view bytes) {
        out.write(bytes);
        hash = fnv1a(bytes, hash);
    };
    std::string header(bytes_of(transport));
    for_each_count(photons.counts, [&](const std::uint64_t& count) { header += bytes_of(count); });
    for (int c = 0; c < 3; ++c) header += bytes_of(photons.flux_unit[c]);
    header += origin.substr(0, longest_header - header.size());
    put(magic);
    put(bytes_of(version));
    put(bytes_of(static_cast<std::uint32_t>(header.size())));
    put(header);
    put(bytes_of(static_cast<std::uint64_t>(photons.store.size())));
    put(bytes_of(photons.store.photons()));
    out.write(bytes_of(hash));
    out.commit();
}

bool is_photon_map(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string start(magic.size(), '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start == magic;
}

TracedPhotons load_photon_map(const std::filesystem::path& file, PhotonMapHeader& header) {
    Reader in(file);
    header = read_header(in);
    const auto count = in.read<std::uint64_t>();
    // Checked before memory is asked for: a damaged count must not reserve the address space.
    if (in.left() / sizeof(Photon) < count) in.fail("ends too early: the photon map is cut short");
    TracedPhotons traced{PhotonStore(count), header.counts, header.flux_unit};
    std::vector<Photon> block(std::min<std::uint64_t>(count, PhotonStore::block_photons));
    for (std::uint64_t read = 0; read < count;) {
        block.resize(std::min<std::uint64_t>(count - read, PhotonStore::block_photons));
        in.read(reinterpret_cast<char*>(block.data()), block.size() * sizeof(Photon));
        traced.store.append(block);
        read += block.size();
    }
    const std::uint64_t hash = in.hash();
    if (in.read<std::uint64_t>() != hash || in.left() != 0)
        in.fail("is damaged: its checksum does not fit");
    return traced;
}

}  // namespace caustics
