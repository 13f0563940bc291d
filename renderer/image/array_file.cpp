#include "renderer/image/array_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "renderer/api/error.h"
#include "renderer/image/atomic_file.h"

namespace tessera {

static_assert(std::endian::native == std::endian::little, "the file is what lies in memory");

struct ArrayFile::Hash {
    XXH3_state_t* state = XXH3_createState();
    Hash() { XXH3_64bits_reset(state); }
    ~Hash() { XXH3_freeState(state); }
    Hash(const Hash&) = delete;
    Hash& operator=(const Hash&) = delete;
    void add(const void* data, std::size_t bytes) { XXH3_64bits_update(state, data, bytes); }
    std::uint64_t value() const { return XXH3_64bits_digest(state); }
};

void ArrayFile::FreeHash::operator()(Hash* h) const { delete h; }

namespace {

// Bytes that no text has: a transfer that mends line ends breaks them.
constexpr unsigned char kMagic[8] = {0x89, 'T', 'S', 'F', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kFormat = 1;
constexpr std::size_t kSum = sizeof(std::uint64_t);

struct Head {
    unsigned char magic[8]{};
    std::uint32_t format = kFormat;
    std::uint32_t arrays = 0;
    std::uint32_t table_bytes = 0;
    std::uint32_t header_bytes = 0;
    std::uint64_t file_bytes = 0;
};
static_assert(sizeof(Head) == 32);

template <class T>
void append(std::string& to, T v) {
    to.append(reinterpret_cast<const char*>(&v), sizeof v);
}

std::string table_of(std::span<const NamedBytes> arrays) {
    std::string table;
    for (const NamedBytes& a : arrays) {
        append(table, static_cast<std::uint64_t>(a.bytes.size()));
        append(table, static_cast<std::uint16_t>(a.name.size()));
        table += a.name.substr(0, 0xffff);
    }
    return table;
}

std::string of_bytes(std::uint64_t there, std::uint64_t whole) {
    return std::to_string(there) + " of " + std::to_string(whole) + " bytes";
}

// What was written is read again before it replaces what was there.
void verify(const AtomicFile& file) {
    try {
        ArrayFile(file.temp_path()).check();
    } catch (const Error& e) {
        fail_output(file.target(), std::string("read back differs: ") + e.what());
    }
}

}  // namespace

std::uint64_t write_array_file(const std::string& path, const std::string& header,
                               std::span<const NamedBytes> arrays) {
    const std::string table = table_of(arrays);
    Head head;
    std::copy(std::begin(kMagic), std::end(kMagic), head.magic);
    head.arrays = static_cast<std::uint32_t>(arrays.size());
    head.table_bytes = static_cast<std::uint32_t>(table.size());
    head.header_bytes = static_cast<std::uint32_t>(header.size());
    head.file_bytes = sizeof head + table.size() + header.size() + kSum;
    for (const NamedBytes& a : arrays) head.file_bytes += a.bytes.size();

    AtomicFile file(path);
    XXH3_state_t* const state = XXH3_createState();
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> owner(state,
                                                                                XXH3_freeState);
    XXH3_64bits_reset(state);
    const auto put = [&](const void* data, std::size_t bytes) {
        XXH3_64bits_update(state, data, bytes);
        file.write(data, bytes);
    };
    put(&head, sizeof head);
    put(table.data(), table.size());
    put(header.data(), header.size());
    for (const NamedBytes& a : arrays) put(a.bytes.data(), a.bytes.size());
    const std::uint64_t sum = XXH3_64bits_digest(state);
    file.write(&sum, sizeof sum);
    const std::uint64_t size = file.finish();
    verify(file);
    file.commit();
    return size;
}

ArrayFile::ArrayFile(const std::string& path) : path_(path), hash_(new Hash) {
    open();
    Head head;
    if (size_ < sizeof head.magic) fail("is no Tessera film file");
    read_bytes(&head, std::min<std::size_t>(sizeof head, size_));
    if (std::memcmp(head.magic, kMagic, sizeof kMagic) != 0) fail("is no Tessera film file");
    if (size_ < sizeof head) fail("is cut short: " + std::to_string(size_) + " bytes");
    if (head.format != kFormat)
        fail("is of format " + std::to_string(head.format) + ", this Tessera reads " +
             std::to_string(kFormat));
    if (size_ < head.file_bytes) fail("is cut short: " + of_bytes(size_, head.file_bytes));
    if (size_ > head.file_bytes)
        fail("is damaged: has " + std::to_string(size_) + " bytes, says " +
             std::to_string(head.file_bytes));
    const std::uint64_t before =
        sizeof head + std::uint64_t{head.table_bytes} + head.header_bytes + kSum;
    if (before > size_) fail("is damaged: its header says more than it holds");
    read_table(head.arrays, head.table_bytes);
    header_.resize(head.header_bytes);
    read_bytes(header_.data(), header_.size());
    std::uint64_t left = size_ - before;
    for (const Entry& e : arrays_) {
        if (e.bytes > left) fail("is damaged: array '" + e.name + "' is longer than the file");
        left -= e.bytes;
    }
    if (left > 0) fail("is damaged: bytes that belong to no array");
}

void ArrayFile::open() {
    // Not blocked by a pipe that nobody writes to.
    const int fd = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) fail("cannot read: " + std::generic_category().message(errno));
    struct stat info {};
    const bool regular = ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
    if (regular) file_.reset(::fdopen(fd, "rb"));
    if (!file_) ::close(fd);
    if (!regular) fail("is not a regular file");
    if (!file_) fail("cannot read: " + std::generic_category().message(errno));
    size_ = static_cast<std::uint64_t>(info.st_size);
}

void ArrayFile::read_bytes(void* to, std::size_t bytes) {
    constexpr std::size_t kPiece = std::size_t{1} << 18;  // hashed while it is in the cache
    auto* at = static_cast<char*>(to);
    while (bytes > 0) {
        const std::size_t piece = std::min(bytes, kPiece);
        if (std::fread(at, 1, piece, file_.get()) != piece) fail("cannot read: it ends early");
        hash_->add(at, piece);
        at += piece, bytes -= piece;
    }
}

void ArrayFile::read_table(std::uint32_t entries, std::uint32_t bytes) {
    std::string table(bytes, '\0');
    read_bytes(table.data(), table.size());
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < entries; ++i) {
        Entry e;
        std::uint16_t length = 0;
        if (table.size() - at < sizeof e.bytes + sizeof length) fail("is damaged: its table ends");
        std::memcpy(&e.bytes, table.data() + at, sizeof e.bytes);
        std::memcpy(&length, table.data() + at + sizeof e.bytes, sizeof length);
        at += sizeof e.bytes + sizeof length;
        if (table.size() - at < length) fail("is damaged: its table ends");
        e.name = table.substr(at, length);
        at += length;
        arrays_.push_back(std::move(e));
    }
    if (at != table.size()) fail("is damaged: its table is too long");
}

void ArrayFile::read(std::span<const std::span<std::byte>> into) {
    if (into.size() != arrays_.size()) throw Error(ExitCode::bug, "film file: other arrays");
    for (std::size_t i = 0; i < into.size(); ++i) {
        if (into[i].size() != arrays_[i].bytes)
            throw Error(ExitCode::bug, "film file: array '" + arrays_[i].name + "' misplaced");
        read_bytes(into[i].data(), into[i].size());
    }
    check_sum();
}

void ArrayFile::check() {
    std::vector<std::byte> piece(std::size_t{1} << 18);
    for (const Entry& e : arrays_) {
        for (std::uint64_t left = e.bytes; left > 0;) {
            const std::size_t bytes = std::min<std::uint64_t>(left, piece.size());
            read_bytes(piece.data(), bytes);
            left -= bytes;
        }
    }
    check_sum();
}

void ArrayFile::check_sum() {
    std::uint64_t sum = 0;
    if (std::fread(&sum, 1, sizeof sum, file_.get()) != sizeof sum)
        fail("cannot read: it ends early");
    if (sum != hash_->value()) fail("is damaged: its checksum differs");
}

void ArrayFile::fail(const std::string& reason) const {
    throw Error(ExitCode::scene, path_ + ": " + reason);
}

}  // namespace tessera
