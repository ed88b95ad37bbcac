  src/encode/choose/between.c: 1:  the others say of a light is missed by so much, in dB.
  src/encode/choose/decide.c: 2:  lamps less. Then components are added, as many as the quality takes; where smoothing keeps th
  src/encode/encode/coded.c: 1:  what the next camera of a slab sees by so many pixels; without one it is this part of 
  src/encode/encode/decide.c: 1: cibel of lights left out then counts as so many of the captured ones, unless one of the
  src/encode/encode/look.c: 2:  by which foretelling is judged: one of so many.
  src/encode/levels/pyramid.c: 1: A view of up to so many pixels is read and relit in half a seco
  src/encode/encode/rate.c: 2: der too where all of them are more than so many times that.
  src/encode/encode/rate.h: 1: How good planes of that PSNR and so many bytes are about, to compare them with o
  src/encode/learn/learn.c: 1: in Lambert: as in so many lights
  src/exchange/formats/web_step.c: 1: in 20 blocks of 8 x 8 pixels is at most so many levels of 255, as far as texture does n
  src/exchange/formats/web_step.h: 1: Rows of at most so many pixels do for trials.
  src/format/codebook/dither.h: 1: tes that the pattern may add, about; 1: as many as it takes
  src/image/image/exr_sums.h: 1: The next part has so many blocks.
