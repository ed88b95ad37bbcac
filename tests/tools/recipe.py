#!/usr/bin/env python3
"""What the recipes of `relume lights --recipe` make of an EXR of layers, beside a picture.

    recipe.py nuke|natron RECIPE LAYERS.exr PICTURE.pfm

Neither program is needed: a Nuke Expression node is parsed by the grammar of its expressions, and the Python
for Natron runs against nodes that know the inputs and parameters of the plugins (openfx-misc) and compute
what these do. Pictures are read here, by no code of relume. Prints the largest difference, a part of the
picture's largest value.
"""
import re
import struct
import sys
import zlib

# ---------------------------------------------------------------- OpenEXR, one part of scan lines


def unzipped(data, size):
    if len(data) == size:
        return data
    raw = bytearray(zlib.decompress(data))
    for i in range(1, size):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


def text_at(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def read_header(data):
    if data[:4] != b'\x76\x2f\x31\x01' or data[5] & 0x1a:
        sys.exit('expected an EXR file of one part of scan lines')
    at, header = 8, {}
    while data[at]:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size, = struct.unpack_from('<i', data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def read_channels(value):
    at, out = 0, []
    while value[at]:
        name, at = text_at(value, at)
        out.append((name, 'e' if struct.unpack_from('<i', value, at)[0] == 1 else 'f'))
        at += 16
    return out


def read_exr(path):
    """{channel: rows}"""
    data = open(path, 'rb').read()
    header, at = read_header(data)
    left, top, right, bottom = struct.unpack('<4i', header['dataWindow'])
    width, height = right - left + 1, bottom - top + 1
    lines = {0: 1, 2: 1, 3: 16}[header['compression'][0]]
    channels = read_channels(header['channels'])
    line = sum(width * struct.calcsize(kind) for _, kind in channels)
    out = {name: [None] * height for name, _ in channels}
    for k in range(-(-height // lines)):
        offset, = struct.unpack_from('<Q', data, at + 8 * k)
        y, size = struct.unpack_from('<ii', data, offset)
        y -= top
        rows = min(lines, height - y)
        block, from_ = unzipped(data[offset + 8:offset + 8 + size], rows * line), 0
        for row in range(y, y + rows):
            for name, kind in channels:
                values = f'<{width}{kind}'
                out[name][row] = struct.unpack_from(values, block, from_)
                from_ += struct.calcsize(values)
    return out


def read_pfm(path):
    """Three planes."""
    kind, width, height, scale, values = re.fullmatch(rb'(PF)\s(\d+)\s(\d+)\s(\S+)\s(.*)', open(path, 'rb').read(), re.S).groups()
    row = 3 * int(width)
    numbers = struct.unpack(f'{"<" if float(scale) < 0 else ">"}{row * int(height)}f', values)
    rows = [numbers[i:i + row] for i in range(0, len(numbers), row)][::-1]
    return [[v for one in rows for v in one[c::3]] for c in range(3)]


def plane(rows):
    return [v for row in rows for v in row]


# ---------------------------------------------------------------- Nuke

TOKEN = re.compile(r'\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)|([-+*()]))')
LETTERS = {'red': 'R', 'green': 'G', 'blue': 'B'}


def nuke_name(channel):
    """As its reader of EXR names them: nothing but letters, digits and _, no digit first."""
    layer, dot, letter = channel.rpartition('.')
    return re.sub(r'\W', '_', layer.lstrip('0123456789')) + dot + {v: k for k, v in LETTERS.items()}.get(letter, letter)


class Expression:
    def __init__(self, text, planes):
        self.tokens, at = [], 0
        while at < len(text.rstrip()):
            found = TOKEN.match(text, at)
            if not found:
                sys.exit(f'Nuke cannot read the expression at: {text[at:at + 20]}')
            self.tokens.append(found.groups())
            at = found.end()
        self.planes, self.count = planes, len(next(iter(planes.values())))

    def take(self, *signs):
        if self.tokens and self.tokens[0][2] in signs:
            return self.tokens.pop(0)[2]
        return None

    def sum(self):
        total = self.product()
        while sign := self.take('+', '-'):
            k = 1 if sign == '+' else -1
            total = [a + k * b for a, b in zip(total, self.product())]
        return total

    def product(self):
        total = self.factor()
        while self.take('*'):
            total = [a * b for a, b in zip(total, self.factor())]
        return total

    def factor(self):
        if self.take('-'):
            return [-v for v in self.factor()]
        if self.take('('):
            inside = self.sum()
            return inside if self.take(')') else sys.exit('expected )')
        number, name, sign = self.tokens.pop(0) if self.tokens else (None, None, 'its end')
        if number:
            return [float(number)] * self.count
        if name not in self.planes:
            sys.exit(f'Nuke knows no channel {name or sign}')
        return self.planes[name]


def run_nuke(text, layers):
    node = re.fullmatch(r'\s*Expression \{\n(.*)\n\}\s*', text, re.S)
    knobs = dict(re.fullmatch(r' (\w+) (?:"(.*)"|(\S+))', line).group(1, 2) for line in node.group(1).split('\n'))
    planes = {nuke_name(name): plane(rows) for name, rows in layers.items()}
    out = []
    for c in range(3):
        expression = Expression(knobs[f'expr{c}'], planes)
        out.append(expression.sum())
        if expression.tokens:
            sys.exit(f'Nuke expects no {expression.tokens[0]} there')
    return out


# ---------------------------------------------------------------- Natron


class Param:
    def __init__(self, choices=None):
        self.choices, self.value = choices, None

    def set(self, *value):
        if self.choices is not None and value[0] not in self.choices:
            raise ValueError(f'no choice {value[0]}')
        self.value = value


class Node:
    """Inputs and parameters of a plugin; a picture is {"R", "G", "B" and "layer.letter": plane}."""

    def __init__(self, inputs, params, compute):
        self.inputs, self.params, self.compute, self.label = [None] * inputs, params, compute, ''

    def connectInput(self, number, node):
        self.inputs[number] = node
        return True

    def getParam(self, name):
        return self.params[name]

    def setLabel(self, label):
        self.label = label

    def picture(self):
        return self.compute(self, [node.picture() for node in self.inputs if node])


def shuffled(node, inputs):
    return {letter: inputs[0][node.params[f'output{letter}'].value[0].removeprefix('B.')] for letter in 'RGB'}


def multiplied(node, inputs):
    return {letter: [node.params['value'].value[c] * v for v in inputs[0][letter]] for c, letter in enumerate('RGB')}


def merged(node, inputs):
    if node.params['operation'].value != ('plus',):
        raise ValueError('not added')
    return {letter: [a + b for a, b in zip(inputs[0][letter], inputs[1][letter])] for letter in 'RGB'}


def run_natron(text, layers):
    planes = {name: plane(rows) for name, rows in layers.items()}
    made = []

    class App:
        def getSelectedNodes(self):
            return [Node(0, {}, lambda node, inputs: planes)]

        def createNode(self, plugin):
            made.append({
                'net.sf.openfx.ShufflePlugin':
                    lambda: Node(2, {f'output{c}': Param({f'B.{name}' for name in planes}) for c in 'RGB'}, shuffled),
                'net.sf.openfx.MultiplyPlugin': lambda: Node(2, {'value': Param()}, multiplied),
                'net.sf.openfx.MergePlugin': lambda: Node(3, {'operation': Param({'plus', 'over', 'multiply'})}, merged),
            }[plugin]())
            return made[-1]

    sys.setrecursionlimit(10000)
    exec(compile(text, 'recipe', 'exec'), {'app1': App()})
    result = next(node for node in made if node.label == 'Environment').picture()
    return [result[letter] for letter in 'RGB']


def main():
    program, recipe, layers, picture = sys.argv[1:]
    got = {'nuke': run_nuke, 'natron': run_natron}[program](open(recipe).read(), read_exr(layers))
    want = read_pfm(picture)
    most = max(abs(v) for channel in want for v in channel)
    print(max(abs(a - b) for x, y in zip(got, want) for a, b in zip(x, y)) / most)


main()
