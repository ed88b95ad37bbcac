// recent.js - what is kept within limits: the least recently used leaves first

// A Map in the order of use.
export class Recent extends Map {
    // Returns a value, which is the most recently used one from now on, or undefined.
    use(key) {
        const value = this.get(key);
        if (value !== undefined) {
            this.delete(key);
            this.set(key, value);
        }
        return value;
    }

    // Takes out the least recently used, one after the other, as long as isFull(); take(value) frees what a value
    // holds. Values for which mayLeave(value) is false stay.
    trim(isFull, take, mayLeave = () => true) {
        for (const [key, value] of this) {
            if (!isFull())
                return;
            if (mayLeave(value)) {
                this.delete(key);
                take(value);
            }
        }
    }
}
