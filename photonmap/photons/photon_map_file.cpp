#include "photonmap/photons/photon_map_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/math/coordinate_limit.h"

namespace caustics::photonmap {

namespace {

static_assert(std::endian::native == std::endian::little, "photons are written as they lie");

constexpr std::string_view magic = "causticbench photon map\n";
/// Of the header, without the command.
std::size_t header_numbers(std::uint32_t version) {
    const std::size_t counts = version == 2 ? 12 : 13;
    const std::size_t words = version < 4 ? 6 : 8;
    return (2 + counts) * sizeof(std::uint64_t) + words * sizeof(std::uint32_t);
}

constexpr std::size_t longest_header = 1 << 20;

template <typename T>
std::string_view bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string_view bytes_of(std::span<const Photon> photons) {
    return {reinterpret_cast<const char*>(photons.data()), photons.size_bytes()};
}

/// The counts in the order of a file of that version.
template <typename Counts, typename Visit>
void for_each_count(std::uint32_t version, Counts& counts, const Visit& visit) {
    for (auto* count :
         {&counts.emitted, &counts.aimed, &counts.branched, &counts.reflected, &counts.refracted,
          &counts.missed, &counts.escaped, &counts.absorbed, &counts.on_black_side,
          &counts.depth_limited, &counts.stored, &counts.dropped})
        visit(*count);
    if (version > 2) visit(counts.misdirected);
}

std::string header_bytes(const TracedPhotons& photons, const PhotonOrigin& origin) {
    std::string header;
    const auto put = [&header](auto value) { header += bytes_of(value); };
    put(origin.transport);
    put(origin.seed);
    put(static_cast<std::uint32_t>(origin.emission));
    put(static_cast<std::uint32_t>(origin.interaction));
    put(static_cast<std::uint32_t>(origin.max_bounces));
    put(static_cast<std::uint32_t>(origin.whole_paths));
    put(static_cast<std::uint32_t>(origin.diffuse_bounces));
    for_each_count(photon_map_version, photons.counts, put);
    for (int c = 0; c < 3; ++c) put(photons.flux_unit[c]);
    return header + origin.command.substr(0, longest_header - header.size());
}

class Reader {
public:
    explicit Reader(const std::filesystem::path& file) : file_(file) {
        require_regular_file(file);
        in_.open(file, std::ios::binary);
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

    void skip(std::uint64_t bytes) { in_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur); }

private:
    std::filesystem::path file_;
    std::ifstream in_;
    std::uint64_t hash_ = fnv1a("");
};

struct Header {
    std::uint32_t version;
    PhotonOrigin origin;
    LightPathCounts counts;
    Spectrum flux_unit;
};

/// Returns the version.
std::uint32_t read_start(Reader& in) {
    std::string start(magic.size(), '\0');
    if (in.left() >= magic.size()) in.read(start.data(), start.size());
    if (start != magic) in.fail("is no photon map of causticbench");
    const auto found = in.read<std::uint32_t>();
    if (found < oldest_photon_map_version || found > photon_map_version)
        in.fail("is a photon map of version " + std::to_string(found) +
                " (known: " + std::to_string(oldest_photon_map_version) + " to " +
                std::to_string(photon_map_version) + ")");
    return found;
}

Header read_header(Reader& in) {
    const std::uint32_t version = read_start(in);
    const auto fail = [&in] { in.fail("is damaged: its header has no sense"); };
    const auto length = in.read<std::uint32_t>();
    if (length < header_numbers(version) || length > longest_header) fail();
    Header header{version, {}, {}, black()};
    header.origin.transport = in.read<std::uint64_t>();
    header.origin.seed = in.read<std::uint64_t>();
    const auto emission = in.read<std::uint32_t>();
    const auto interaction = in.read<std::uint32_t>();
    const auto max_bounces = in.read<std::uint32_t>();
    if (emission > 1 || interaction > 1 || max_bounces > std::numeric_limits<int>::max()) fail();
    header.origin.emission = static_cast<PhotonMapParams::Emission>(emission);
    header.origin.interaction = static_cast<Interaction>(interaction);
    header.origin.max_bounces = static_cast<int>(max_bounces);
    if (version > 3) {
        const auto whole_paths = in.read<std::uint32_t>();
        const auto diffuse_bounces = in.read<std::uint32_t>();
        if (whole_paths > 1 || diffuse_bounces > std::numeric_limits<int>::max()) fail();
        header.origin.whole_paths = whole_paths == 1;
        header.origin.diffuse_bounces = static_cast<int>(diffuse_bounces);
    }
    for_each_count(version, header.counts,
                   [&](std::uint64_t& count) { count = in.read<std::uint64_t>(); });
    for (int c = 0; c < 3; ++c) header.flux_unit[c] = in.read<float>();
    header.origin.command.resize(length - header_numbers(version));
    in.read(header.origin.command.data(), header.origin.command.size());
    return header;
}

/// A right checksum says only that the file is as it was written.
void require_sense(const Reader& in, const TracedPhotons& photons) {
    const std::span<const Photon> all = photons.store.photons();
    const Spectrum unit = all.empty() ? photons.flux_unit : photons.flux_per_energy();
    if (!is_finite(unit) || unit.minCoeff() < 0)
        in.fail("is damaged: the unit of its photons' flux is negative or not finite");
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!within_limit(position(all[i])))
            in.fail("is damaged: the place of photon " + std::to_string(i) +
                    " is not finite or beyond every scene");
        if (!is_finite(decode_rgbe(all[i].energy) * unit))
            in.fail("is damaged: the flux of photon " + std::to_string(i) + " is not finite");
    }
}

}  // namespace

void save_photon_map(const TracedPhotons& photons, const PhotonOrigin& origin,
                     const std::filesystem::path& file) {
    AtomicFile out(file);
    std::uint64_t hash = fnv1a("");
    const auto put = [&](std::string_view bytes) {
        out.write(bytes);
        hash = fnv1a(bytes, hash);
    };
    const std::string header = header_bytes(photons, origin);
    put(magic);
    put(bytes_of(photon_map_version));
    put(bytes_of(static_cast<std::uint32_t>(header.size())));
    put(header);
    put(bytes_of(static_cast<std::uint64_t>(photons.store.size())));
    put(bytes_of(photons.store.photons()));
    out.write(bytes_of(hash));
    out.commit();
}

bool is_photon_map(const std::filesystem::path& file) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) return false;
    std::ifstream in(file, std::ios::binary);
    std::string start(magic.size(), '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    return start == magic;
}

SavedPhotons load_photon_map(const std::filesystem::path& file) {
    Reader in(file);
    Header header = read_header(in);
    const auto count = in.read<std::uint64_t>();
    // Checked before memory is asked for: a damaged count must not reserve the address space.
    if (in.left() / sizeof(Photon) < count) in.fail("ends too early: the photon map is cut short");
    TracedPhotons photons{PhotonStore(count, count), header.counts, header.flux_unit};
    for (std::uint64_t read = 0; read < count; read = photons.store.size()) {
        const std::span<Photon> block =
            photons.store.extend(std::min<std::uint64_t>(count - read, PhotonStore::block_photons));
        in.read(reinterpret_cast<char*>(block.data()), block.size_bytes());
    }
    photons.store.settle();
    const std::uint64_t hash = in.hash();
    if (in.read<std::uint64_t>() != hash || in.left() != 0 || header.counts.stored != count)
        in.fail("is damaged: its checksum does not fit");
    require_sense(in, photons);
    return {std::move(photons), std::move(header.origin), header.version};
}

std::uint64_t photon_map_checksum(const std::filesystem::path& file) {
    Reader in(file);
    read_start(in);
    if (in.left() < sizeof(std::uint64_t)) in.fail("ends too early: the photon map is cut short");
    in.skip(in.left() - sizeof(std::uint64_t));
    return in.read<std::uint64_t>();
}

}  // namespace caustics::photonmap
