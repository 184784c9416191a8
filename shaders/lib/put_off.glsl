/* Trees that wait for the second round. Expects `view`, `counts` and `put_off` (uint[]). */

/* Some of the 32 trees that a word stands for. */
void put_off_trees(uint word, uint mask)
{
    if (atomicOr(put_off[word], mask) == 0u)
        put_off[view.put_off_words + atomicAdd(counts.put_off, 1u)] = word;
}
