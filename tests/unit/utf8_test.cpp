// Names as UTF-8.
#include "renderer/core/utf8.h"

#include <doctest/doctest.h>

using namespace tessera;

TEST_CASE("utf8: what is one is left alone") {
    for (const std::string text : {"", "plain", "Küche", "равнина", "\xf0\x9f\x98\x80",
                                   "\xf4\x8f\xbf\xbf", "\xed\x9f\xbf", "tab\there"}) {
        CAPTURE(text);
        CHECK(is_utf8(text));
        CHECK(as_utf8(text) == text);
    }
}

TEST_CASE("utf8: cut, overlong, surrogate and other bytes are none") {
    for (const std::string text : {"\xff", "\x80", "\xc3", "\xe2\x82", "\xc0\xaf", "\xc1\xbf",
                                   "\xe0\x80\xaf", "\xed\xa0\x80", "\xf0\x80\x80\xaf",
                                   "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xc3x"}) {
        CAPTURE(text.size());
        CHECK_FALSE(is_utf8(text));
        CHECK(is_utf8(as_utf8(text)));
    }
}

TEST_CASE("utf8: other bytes are Latin-1's") {
    CHECK(as_utf8("K\xfc"
                  "che") == "Küche");
    CHECK(as_utf8("\xff") == "ÿ");
}
