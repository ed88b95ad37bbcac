"""The check sums of a relume file, by docs/format.md and nothing else: no OpenEXR, nothing of relume.

    sums.py FILE...                 each file is whole, and every byte of it is in a sum
    sums.py --flip N FILE FOLDER    N copies of it with one bit changed in each, spread over all of it
    sums.py --mend FILE             its sums become those of what it holds now
"""

import os
import random
import struct
import sys
import zlib


class Damaged(Exception):
    pass


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end], end + 1


def header_of(data, at):
    """The attributes of a part, by name, and where they end."""
    attributes = {}
    while data[at]:
        name, at = text(data, at)
        kind, at = text(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def headers_of(data):
    at, parts = 8, []
    while data[at]:
        attributes, at = header_of(data, at)
        parts.append(attributes)
    return parts, at + 1


class Sums:
    """What a file holds: `head`, the end of what comes before the first block; `blocks`, name, begin
    and end of each; `rows`, begin and end of the words of sums."""

    def __init__(self, data):
        parts, at = headers_of(data)
        if parts[0].get("relume.sums") != b"crc32" or parts[-1]["name"] != b"sums":
            raise Damaged("no sums")
        places = []
        for part in parts:
            count, = struct.unpack("<i", part["chunkCount"])
            places.append(struct.unpack_from("<%dQ" % count, data, at))
            at += 8 * count
        self.head = at
        self.blocks, self.rows = [], []
        for number, (part, begins) in enumerate(zip(parts, places)):
            lead = 24 if part["type"] == b"tiledimage" else 12  # bytes before those of the block
            for begin in begins:
                size, = struct.unpack_from("<i", data, begin + lead - 4)
                if number == len(parts) - 1:
                    self.rows.append((begin + lead, begin + lead + size))
                else:
                    self.blocks.append((part["name"].decode(), begin, begin + lead + size))
        self.words = b"".join(bytes(data[a:b]) for a, b in self.rows)

    def wanted(self, data):
        """The words as they should be."""
        sums = [zlib.crc32(data[:self.head])]
        sums += [zlib.crc32(data[begin:end]) for name, begin, end in self.blocks]
        words = struct.pack("<%dI" % len(sums), *sums).ljust(len(self.words) - 4, b"\0")
        return words + struct.pack("<I", zlib.crc32(words))


def check(data):
    sums = Sums(data)
    wanted = sums.wanted(data)
    if zlib.crc32(sums.words[:-4]) != struct.unpack("<I", sums.words[-4:])[0]:
        raise Damaged("the sums themselves")
    names = ["headers or tables"] + [name for name, begin, end in sums.blocks]
    for i in range(0, len(wanted) - 4, 4):
        if wanted[i:i + 4] != sums.words[i:i + 4]:
            raise Damaged(names[i // 4] if i // 4 < len(names) else "words that should be 0")
    end = sums.head
    for begin, after in sorted([block[1:] for block in sums.blocks] + [(a - 12, b) for a, b in sums.rows]):
        if begin != end:
            raise Damaged("bytes from %d on are in no sum" % end)
        end = after
    if end != len(data):
        raise Damaged("bytes from %d on are in no sum" % end)
    return len(names)


def mend(path):
    data = bytearray(open(path, "rb").read())
    sums = Sums(data)
    wanted = sums.wanted(data)
    for begin, end in sums.rows:
        data[begin:end], wanted = wanted[:end - begin], wanted[end - begin:]
    with open(path, "wb") as out:
        out.write(data)


def flip(count, path, folder):
    data = bytearray(open(path, "rb").read())
    chance = random.Random(1)
    os.makedirs(folder, exist_ok=True)
    for i in range(count):
        at = (2 * i + 1) * len(data) // (2 * count)
        bit = 1 << chance.randrange(8)
        data[at] ^= bit
        with open(os.path.join(folder, "byte%08d" % at), "wb") as out:
            out.write(data)
        data[at] ^= bit


def main(words):
    if words[0] == "--flip":
        flip(int(words[1]), words[2], words[3])
        return 0
    if words[0] == "--mend":
        mend(words[1])
        return 0
    bad = 0
    for path in words:
        try:
            print("%s: %d sums" % (path, check(open(path, "rb").read())))
        except (Damaged, struct.error, ValueError, IndexError, KeyError) as why:
            print("%s: %s" % (path, why))
            bad = 1
    return bad


sys.exit(main(sys.argv[1:]))
