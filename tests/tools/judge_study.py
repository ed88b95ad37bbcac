#!/usr/bin/env python3
"""Sound captures and ten ways to damage them: what does `relume capture` say?

usage: judge_study.py RELUME WORK NAME=FOLDER[:LIST] ... [--only DAMAGE,...] [--size PIXELS] [--photos N]

FOLDER holds photographs and a list LIST (a .lp file; default FOLDER/dirs.lp). Copies of at most N
photographs (default 24), PIXELS wide (default 220), are captured as they are and damaged. Prints for each
whether a warning or an error names the damage, what else is said, and a table. Needs numpy, Pillow.
"""
import os, re, subprocess, sys
import numpy as np
from PIL import Image, ImageFilter


def read_list(path):
    rows = [r.split() for r in open(path) if len(r.split()) >= 4]
    return [os.path.basename(r[0]) for r in rows], np.array([[float(x) for x in r[1:4]] for r in rows])


def linear(u):
    v = u / 255.0
    return np.where(v <= .04045, v / 12.92, ((v + .055) / 1.055) ** 2.4)


def coded(v):
    v = np.clip(v, 0, 1)
    return (np.where(v <= .0031308, 12.92 * v, 1.055 * np.clip(v, 1e-9, 1) ** (1 / 2.4) - .055) * 255 + .5).astype(np.uint8)


def person(v):
    """A shadow over a third of the picture, of a quarter of the light."""
    x = np.arange(v.shape[1]) / v.shape[1]
    return v * (1 - .75 / (1 + np.exp((x - .35) / .03)))[None, :, None]


# Damages of photograph i: (pictures linear, lights, files) changed in place; what the words must be.
def shift(c, i, r): c.change(i, lambda v: np.roll(v, (2, 4), (0, 1)))
def order(c, i, r): c.lights = c.lights[r.permutation(len(c.lights))]
def misfire(c, i, r): c.change(i, lambda v: v * .001)
def blur(c, i, r): c.picture[i] = c.picture[i].filter(ImageFilter.GaussianBlur(1.5))
def exposure(c, i, r): c.change(i, lambda v: v * .5)
def mirrored(c, i, r): c.lights = c.lights * [1, -1, 1]
def scene(c, i, r): c.picture[i] = c.other.resize(c.picture[i].size)
def shadow(c, i, r): c.change(i, person)
def twice(c, i, r): c.same = (i, (i + len(c.names) // 2) % len(c.names))
def turned(c, i, r): c.picture[i] = c.picture[i].transpose(Image.ROTATE_180)


LIST = r'do not fit the lights|looks like the photographs under|the list fits|elsewhere'
DAMAGES = {
    'shift': (shift, r'{}.*(camera was moved|not fit|another scene)'),
    'order': (order, LIST),
    'misfire': (misfire, r'{}.*(black|left out|not fit)'),
    'blur': (blur, r'{}.*less sharp'),
    'exposure': (exposure, r'{}.*not fit'),
    'mirrored': (mirrored, LIST),
    'scene': (scene, r'{}.*(another scene|left out|not fit)'),
    'shadow': (shadow, r'{}.*not fit'),
    'twice': (twice, r'{}.*(same photograph)'),
    'turned': (turned, r'{}.*(another scene|not fit|left out)'),
}


class Capture:
    def __init__(self, folder, path, size, photos, other):
        self.names, self.lights = read_list(path)
        step = max(1, -(-len(self.names) // photos))
        self.names, self.lights = self.names[::step], self.lights[::step]
        self.picture = []
        for n in self.names:
            im = Image.open(os.path.join(folder, n)).convert('RGB')
            im.thumbnail((size, size), Image.LANCZOS)
            self.picture.append(im)
        self.other, self.same = other, None

    def copy(self):
        c = object.__new__(Capture)
        c.__dict__ = dict(self.__dict__, picture=list(self.picture))
        return c

    def change(self, i, f):
        self.picture[i] = Image.fromarray(coded(f(linear(np.asarray(self.picture[i]).astype(float)))))

    def write(self, out):
        os.makedirs(out, exist_ok=True)
        for f in os.listdir(out):
            os.unlink(os.path.join(out, f))
        for i, p in enumerate(self.picture):
            q = self.picture[self.same[1]] if self.same and i == self.same[0] else p
            q.save(f'{out}/p{i:02d}.jpg', quality=95)
        with open(f'{out}/l.lp', 'w') as f:
            f.write(f'{len(self.lights)}\n')
            for i, l in enumerate(self.lights):
                f.write(f'p{i:02d}.jpg {l[0]:.6f} {l[1]:.6f} {l[2]:.6f}\n')


def said(relume, work):
    r = subprocess.run([relume, 'capture', work + '/in', '--lights', work + '/in/l.lp', '-o', work + '/out', '--force'],
                       capture_output=True, text=True)
    # report.html names all of those that the terminal sums up
    text = re.sub(r'<[^>]*>', ' ', re.search(r'<h2>Warnings</h2>(.*?)</table>', open(work + '/out/report.html').read(), re.S)
                  .group(1).replace('</div>', '\n')) if r.returncode == 0 else r.stderr
    return [l.strip() for l in text.split('\n')
            if re.search(r'not fit|sharp|scene|moved|black|left out|same photo|elsewhere|surface looks|list fits', l)]


def main():
    args, option = [], {'--only': None, '--size': '220', '--photos': '24'}
    rest = sys.argv[1:]
    while rest:
        a = rest.pop(0)
        if a in option: option[a] = rest.pop(0)
        else: args.append(a)
    if len(args) < 3: sys.exit(__doc__)
    relume, work = args[:2]
    captures = {}
    for a in args[2:]:
        name, folder = a.split('=')
        folder, _, path = folder.partition(':')
        captures[name] = (folder, path or folder + '/dirs.lp')
    only = option['--only'].split(',') if option['--only'] else list(DAMAGES)
    named, false, runs = dict.fromkeys(only, 0), 0, 0
    names = list(captures)
    for k, name in enumerate(names):
        other_folder, other_path = captures[names[(k + len(names) // 2) % len(names)]]
        other = Image.open(os.path.join(other_folder, read_list(other_path)[0][5])).convert('RGB')
        sound = Capture(*captures[name], int(option['--size']), int(option['--photos']), other)
        sound.write(work + '/in')
        usual = said(relume, work)
        false += bool(usual)
        print(f'{name}: {len(usual)} warnings', *usual[:3], sep='\n    ', flush=True)
        for kind in only:
            damage, words = DAMAGES[kind]
            r = np.random.default_rng(17 * k + only.index(kind))
            i = int(r.integers(2, len(sound.names) - 2))
            c = sound.copy()
            damage(c, i, r)
            c.write(work + '/in')
            lines = [l for l in said(relume, work) if l not in usual]
            found = any(re.search(words.format(f'p{i:02d}.jpg'), l) for l in lines)
            named[kind] += found
            runs += 1
            if not found or len(lines) > 2:
                print(f'  {kind} of {i}: {"named" if found else "NOT NAMED"}', *(l[:150] for l in lines[:4]), sep='\n      ', flush=True)
    print(f'sound captures with warnings: {false} of {len(names)}')
    for kind in only: print(f'{kind}: {named[kind]} of {len(names)}')
    print(f'all: {sum(named.values())} of {runs}')


main()
