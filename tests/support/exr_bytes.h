#pragma once
// EXR files byte by byte, so that a test can write what no library would: any codec by name (its
// chunks stored as they are, which every codec allows), any attribute, any type.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace tessera {

struct ExrBytes {
    enum Type { integer, half, real };
    using Values = std::function<float(int x, int y)>;
    struct Channel {
        std::string name;
        Type type = half;
        Values value = [](int, int) { return 0.5f; };
    };
    struct Attribute {
        std::string name, type, bytes;
    };
    struct Part {
        std::vector<Channel> channels;
        int x0 = 0, y0 = 0, x1 = 8, y1 = 4;  // data; x1, y1 excluded
        int width = 8, height = 4;           // display
        int compression = 0;
        std::vector<Attribute> attributes;
        std::string name = {};
    };
    std::vector<Part> parts;

    Part& part() { return parts[0]; }
    /// The channel of that name, new at the end if there is none.
    Channel& channel(const std::string& name, std::size_t in = 0) {
        for (Channel& c : parts[in].channels)
            if (c.name == name) return c;
        parts[in].channels.push_back({name, half, [](int, int) { return 0.5f; }});
        return parts[in].channels.back();
    }
    void attribute(const std::string& name, const std::string& text) {
        part().attributes.push_back({name, "string", text});
    }

    std::string bytes() const {
        const bool multipart = parts.size() > 1;
        std::string out;
        put(out, 20000630);
        put(out, 2 | (multipart ? 0x1000 : 0) | 0x400);
        for (const Part& p : parts) header(out, p, multipart);
        if (multipart) out += '\0';
        std::vector<std::string> chunks;
        for (std::size_t i = 0; i < parts.size(); ++i)
            for (int y = parts[i].y0; y < parts[i].y1; y += lines(parts[i].compression))
                chunks.push_back(chunk(i, y));
        std::uint64_t offset = out.size() + 8 * chunks.size();
        for (const std::string& c : chunks) {
            put(out, static_cast<std::int64_t>(offset));
            offset += c.size();
        }
        for (const std::string& c : chunks) out += c;
        return out;
    }

private:
    template <class T>
    static void put(std::string& out, T value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        out.append(raw, sizeof value);
    }
    static int lines(int compression) {
        const int all[]{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
        return all[compression];
    }
    static std::vector<Channel> sorted(const Part& p) {
        std::vector<Channel> list = p.channels;
        std::sort(list.begin(), list.end(),
                  [](const Channel& a, const Channel& b) { return a.name < b.name; });
        return list;
    }
    static void add(std::string& out, const std::string& name, const std::string& type,
                    const std::string& value) {
        out += name + '\0' + type + '\0';
        put(out, static_cast<std::int32_t>(value.size()));
        out += value;
    }
    static std::string box(int x0, int y0, int x1, int y1) {
        std::string b;
        for (const int v : {x0, y0, x1 - 1, y1 - 1}) put(b, v);
        return b;
    }
    static void header(std::string& out, const Part& p, bool multipart) {
        std::string list;
        for (const Channel& c : sorted(p)) {
            list += c.name + '\0';
            put(list, static_cast<std::int32_t>(c.type));
            put(list, 0);
            put(list, 1);
            put(list, 1);
        }
        list += '\0';
        std::string one, zeros;
        put(one, 1.0f);
        put(zeros, std::int64_t{0});
        add(out, "channels", "chlist", list);
        add(out, "compression", "compression", std::string(1, static_cast<char>(p.compression)));
        add(out, "dataWindow", "box2i", box(p.x0, p.y0, p.x1, p.y1));
        add(out, "displayWindow", "box2i", box(0, 0, p.width, p.height));
        add(out, "lineOrder", "lineOrder", std::string(1, '\0'));
        add(out, "pixelAspectRatio", "float", one);
        add(out, "screenWindowCenter", "v2f", zeros);
        add(out, "screenWindowWidth", "float", one);
        if (multipart) {
            std::string count;
            put(count, (p.y1 - p.y0 + lines(p.compression) - 1) / lines(p.compression));
            add(out, "chunkCount", "int", count);
            add(out, "name", "string", p.name);
            add(out, "type", "string", "scanlineimage");
        }
        for (const Attribute& a : p.attributes) add(out, a.name, a.type, a.bytes);
        out += '\0';
    }
    std::string chunk(std::size_t index, int y) const {
        const Part& p = parts[index];
        std::string data;
        for (int line = y; line < std::min(y + lines(p.compression), p.y1); ++line)
            for (const Channel& c : sorted(p))
                for (int x = p.x0; x < p.x1; ++x) value(data, c.type, c.value(x, line));
        std::string out;
        if (parts.size() > 1) put(out, static_cast<std::int32_t>(index));
        put(out, y);
        put(out, static_cast<std::int32_t>(data.size()));
        return out + data;
    }
    static void value(std::string& out, Type type, float v) {
        if (type == real) return put(out, v);
        if (type == integer) return put(out, static_cast<std::uint32_t>(v));
        std::uint16_t bits = 0;
        const float a = std::abs(v);
        if (std::isnan(v)) {
            bits = 0x7e00;
        } else if (std::isinf(v)) {
            bits = 0x7c00;
        } else if (a > 0) {
            const int e = std::max(std::ilogb(a), -14);
            const auto mantissa = static_cast<int>(std::lround(std::ldexp(a, 10 - e)));
            bits = static_cast<std::uint16_t>(((e + 14) << 10) + mantissa);
        }
        put(out, static_cast<std::uint16_t>(bits | (std::signbit(v) ? 0x8000 : 0)));
    }
};

}  // namespace tessera
