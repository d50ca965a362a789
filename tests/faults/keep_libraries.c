/* Preloaded under AddressSanitizer: a driver that stays loaded can be named in its leak reports,
 * and so be told apart from lavaray. */
int dlclose(void *handle);

int dlclose(void *handle)
{
    (void)handle;
    return 0;
}
